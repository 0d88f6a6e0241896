#include "tools/convert/compact_stream.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "ooc/paged_table.h"

namespace reeb::tools {
namespace {

constexpr std::size_t kStretch = 4096;  // triangles taken at once
constexpr std::uint64_t kNone = ~std::uint64_t{0};

struct Place {
  std::uint64_t last = kNone;    // the last triangle that names the vertex
  std::uint64_t number = kNone;  // its new one
};

class CompactStream {
 public:
  CompactStream(IndexedMesh& mesh, unsigned dimension, bool exact, io::MeshWriter& writer, Workspace& space)
      : mesh_(mesh),
        exact_(exact),
        writer_(writer),
        places_("finalization", space.temp, space.budget, 3 * space.share(), Place{}),
        columns_(mesh.column_count()),
        dimension_(dimension) {
    std::iota(columns_.begin(), columns_.end(), 0u);
    batch_.coordinates.resize(dimension);
    batch_.properties.resize(columns_.size() - dimension);
  }

  void run() {
    find_last_triangles();
    std::uint64_t triangle = 0;
    mesh_.rewind();
    while (mesh_.read(corners_, kStretch)) {
      number_new_vertices();
      for (std::size_t t = 0; t < corners_.size(); t += 3) write_triangle(t, triangle++);
      if (!exact_) send();
    }
    write_unused();
  }

 private:
  void find_last_triangles() {
    std::uint64_t first = 0;
    mesh_.rewind();
    while (mesh_.read(corners_, kStretch)) {
      for (std::size_t c = 0; c < corners_.size(); ++c) places_.change(corners_[c].value()).last = first + c / 3;
      first += corners_.size() / 3;
    }
  }

  // Of the stretch at hand; their columns are looked up together.
  void number_new_vertices() {
    new_ids_.clear();
    new_used_ = 0;
    for (const VertexId v : corners_) {
      Place& place = places_.change(v.value());
      if (place.number != kNone) continue;
      place.number = numbered_++;
      new_ids_.push_back(v);
    }
    gather_new();
  }

  // Looked up in ascending order, since scattered places of a file cost a mapping each.
  void gather_new() {
    const std::size_t count = new_ids_.size();
    by_id_.resize(count);
    std::iota(by_id_.begin(), by_id_.end(), std::size_t{0});
    std::sort(by_id_.begin(), by_id_.end(), [this](std::size_t a, std::size_t b) { return new_ids_[a] < new_ids_[b]; });
    sorted_ids_.clear();
    for (const std::size_t i : by_id_) sorted_ids_.push_back(new_ids_[i]);
    gathered_.resize(columns_.size() * count);
    mesh_.gather(sorted_ids_, columns_, gathered_);
    values_.resize(gathered_.size());
    for (std::size_t k = 0; k < columns_.size(); ++k)
      for (std::size_t i = 0; i < count; ++i) values_[k * count + by_id_[i]] = gathered_[k * count + i];
  }

  void write_triangle(std::size_t t, std::uint64_t triangle) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Place place = places_.get(corners_[t + c].value());
      if (place.number == sent_) add_vertex();
      batch_.triangles.emplace_back(place.number);
    }
    if (!exact_) return;
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId v = corners_[t + c];
      const bool repeated = (c > 0 && v == corners_[t]) || (c > 1 && v == corners_[t + 1]);
      if (const Place place = places_.get(v.value()); place.last == triangle && !repeated)
        batch_.finalized.emplace_back(place.number);
    }
    send();
  }

  // The next of the new vertices, which come in the order of their numbers.
  void add_vertex() {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      auto& column = k < dimension_ ? batch_.coordinates[k] : batch_.properties[k - dimension_];
      column.push_back(values_[k * new_ids_.size() + new_used_]);
    }
    ++new_used_;
    ++sent_;
    ++batch_.vertex_count;
  }

  void write_unused() {
    const std::uint64_t count = mesh_.vertex_count();
    for (std::uint64_t v = 0; v < count;) {
      new_ids_.clear();
      new_used_ = 0;
      for (; v < count && new_ids_.size() < kStretch; ++v)
        if (places_.get(v).last == kNone) new_ids_.emplace_back(v);
      gather_new();
      for (std::size_t i = 0; i < new_ids_.size(); ++i) {
        if (exact_) batch_.finalized.emplace_back(sent_);
        add_vertex();
        if (exact_) send();
      }
      send();
    }
  }

  void send() {
    if (batch_.empty()) return;
    writer_.write(batch_);
    batch_.clear();
    batch_.first_vertex = VertexId(sent_);
  }

  IndexedMesh& mesh_;
  bool exact_;
  io::MeshWriter& writer_;
  ooc::PagedTable<Place> places_;
  std::vector<unsigned> columns_;
  unsigned dimension_;
  std::uint64_t numbered_ = 0, sent_ = 0;  // vertices with a number, and those that were written
  std::vector<VertexId> corners_, new_ids_, sorted_ids_;
  std::vector<std::size_t> by_id_;
  std::vector<double> values_, gathered_;  // of new_ids_ and of sorted_ids_, by column
  std::size_t new_used_ = 0;
  MeshBatch batch_;
};

}  // namespace

void write_compact(IndexedMesh& mesh, unsigned dimension, bool exact, io::MeshWriter& writer, Workspace& space) {
  CompactStream(mesh, dimension, exact, writer, space).run();
}

}  // namespace reeb::tools
