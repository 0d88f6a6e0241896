#include "ooc/whole_mesh/compact_stream.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "ooc/tables/paged_table.h"
#include "ooc/whole_mesh/triangle_stretches.h"

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kNone = ~std::uint64_t{0};
constexpr std::size_t kUnusedAtOnce = 4096;

struct Place {
  std::uint64_t last = kNone;    // the last triangle that names the vertex
  std::uint64_t number = kNone;  // its new number
};

class CompactStream {
 public:
  CompactStream(IndexedMesh& mesh, unsigned dimension, bool exact, MeshWriter& writer, Workspace& space)
      : mesh_(mesh),
        exact_(exact),
        writer_(writer),
        space_(space),
        places_("finalization", space.temp, space.budget, 3 * space.share(), Place{}),
        columns_(mesh.column_count()) {
    std::iota(columns_.begin(), columns_.end(), 0u);
    batch_.coordinates.resize(dimension);
    batch_.properties.resize(columns_.size() - dimension);
  }

  void run() {
    find_last_triangles();
    for (TriangleStretches stretch("compact stream", mesh_, space_); stretch.next();) {
      number_new_vertices(stretch);
      for (std::size_t t = 0; t < stretch.corners().size(); t += 3)
        write_triangle(stretch.numbers().subspan(t).first<3>(), stretch.first_triangle() + t / 3);
      if (!exact_) send();
    }
    write_unused();
  }

 private:
  void find_last_triangles() {
    std::vector<std::uint64_t> last;
    for (TriangleStretches stretch("compact stream", mesh_, space_); stretch.next();) {
      last.resize(stretch.vertices().size());
      for (std::size_t c = 0; c < stretch.corners().size(); ++c)
        last[stretch.numbers()[c]] = stretch.first_triangle() + c / 3;
      for (const std::uint32_t n : stretch.lookup_order()) places_.change(stretch.vertices()[n].value()).last = last[n];
    }
  }

  // Numbers new vertices by first appearance. Their columns are looked up together.
  void number_new_vertices(const TriangleStretches& stretch) {
    const auto vertices = stretch.vertices();
    here_.resize(vertices.size());
    for (const std::uint32_t n : stretch.lookup_order()) here_[n] = places_.get(vertices[n].value());
    const std::uint64_t first_new = numbered_;
    for (Place& place : here_)
      if (place.number == kNone) place.number = numbered_++;
    new_ids_.clear();
    new_places_.clear();
    // Backwards, since the pages read last are still in memory.
    const auto order = stretch.lookup_order();
    for (auto it = order.rbegin(); it != order.rend(); ++it) {
      const std::uint32_t n = *it;
      if (here_[n].number < first_new) continue;
      places_.change(vertices[n].value()).number = here_[n].number;
      new_ids_.push_back(vertices[n]);
      new_places_.push_back(static_cast<std::size_t>(here_[n].number - first_new));
    }
    gather_new();
  }

  // Gathers the columns of the new ids and puts the values in the order of first appearance.
  void gather_new() {
    const std::size_t count = new_ids_.size();
    new_used_ = 0;
    gathered_.resize(columns_.size() * count);
    mesh_.gather(new_ids_, columns_, gathered_);
    values_.resize(gathered_.size());
    for (std::size_t k = 0; k < columns_.size(); ++k)
      for (std::size_t i = 0; i < count; ++i) values_[k * count + new_places_[i]] = gathered_[k * count + i];
  }

  void write_triangle(std::span<const std::uint32_t, 3> corners, std::uint64_t triangle) {
    for (const std::uint32_t n : corners) {
      if (here_[n].number == sent_) add_vertex();
      batch_.triangles().emplace_back(here_[n].number);
    }
    if (!exact_) return;
    for (std::size_t c = 0; c < 3; ++c) {
      const bool repeated = (c > 0 && corners[c] == corners[0]) || (c > 1 && corners[c] == corners[1]);
      const Place& place = here_[corners[c]];
      if (place.last == triangle && !repeated) batch_.finalized.emplace_back(place.number);
    }
    send();
  }

  // Adds the next new vertex. New vertices come in the order of their numbers.
  void add_vertex() {
    for (std::size_t k = 0; k < columns_.size(); ++k)
      batch_.column(k).push_back(values_[k * new_ids_.size() + new_used_]);
    ++new_used_;
    ++sent_;
    ++batch_.vertex_count;
  }

  void write_unused() {
    const std::uint64_t count = mesh_.vertex_count();
    for (std::uint64_t v = 0; v < count;) {
      new_ids_.clear();
      for (; v < count && new_ids_.size() < kUnusedAtOnce; ++v)
        if (places_.get(v).last == kNone) new_ids_.emplace_back(v);
      new_places_.resize(new_ids_.size());
      std::iota(new_places_.begin(), new_places_.end(), std::size_t{0});
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
  MeshWriter& writer_;
  Workspace& space_;
  PagedTable<Place> places_;
  std::vector<unsigned> columns_;
  std::uint64_t numbered_ = 0, sent_ = 0;  // vertices that have a number, and vertices that were written
  std::vector<Place> here_;                // of the vertices of the current stretch
  std::vector<VertexId> new_ids_;
  std::vector<std::size_t> new_places_;    // of the new ids, among them by first appearance
  std::vector<double> gathered_, values_;  // by column, then by new id, or by place
  std::size_t new_used_ = 0;
  MeshBatch batch_;
};

}  // namespace

void write_compact(IndexedMesh& mesh, unsigned dimension, bool exact, MeshWriter& writer, Workspace& space) {
  CompactStream(mesh, dimension, exact, writer, space).run();
}

}  // namespace reeb::ooc
