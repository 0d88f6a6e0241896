#include "ooc/whole_mesh/triangle_order.h"

#include <algorithm>
#include <array>
#include <utility>

#include "libreeb/base/sweep_key.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/tables/triangle_log.h"
#include "ooc/threads/machine_threads.h"
#include "ooc/whole_mesh/fiedler.h"
#include "ooc/whole_mesh/reorder.h"
#include "ooc/whole_mesh/triangle_stretches.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kKeyedAtOnce = 4096;

struct KeyedTriangle {
  double value;
  std::uint64_t highest, place;
  std::array<std::uint64_t, 3> corners;
  friend bool operator<(const KeyedTriangle& a, const KeyedTriangle& b) {
    return std::tie(a.value, a.highest, a.place) < std::tie(b.value, b.highest, b.place);
  }
};

// The vertices of a mesh with its triangles in another order.
class OrderedMesh : public IndexedMesh {
 public:
  OrderedMesh(std::unique_ptr<IndexedMesh> mesh, Workspace& space)
      : mesh_(std::move(mesh)), triangles_(space.temp, space.budget, space.share()) {}

  IndexedMesh& vertices() { return *mesh_; }
  void append(std::span<const VertexId> corners) { triangles_.append(corners); }

  std::uint64_t vertex_count() const override { return mesh_->vertex_count(); }
  unsigned column_count() const override { return mesh_->column_count(); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    mesh_->gather(ids, columns, values);
  }
  SimplexCounts simplex_counts() const override { return mesh_->simplex_counts(); }
  void rewind() override { triangles_.rewind(); }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override { return triangles_.read(corners, limit); }
  std::uint64_t bytes_read() const override { return triangles_.bytes_read(); }
  std::uint64_t bytes_total() const override { return triangles_.bytes_total(); }

 private:
  std::unique_ptr<IndexedMesh> mesh_;
  TriangleLog triangles_;
};

// The numbers of vertices that a function understands.
enum class Numbering { kOfInput, kOfMesh };

// The values of a function at the vertices of a stretch.
class StretchValues {
 public:
  StretchValues(IndexedMesh& mesh, VertexFunction& function, Numbering numbering)
      : mesh_(mesh), function_(function), numbering_(numbering) {}

  // The values by number.
  std::span<const double> operator()(const TriangleStretches& stretch) {
    const auto order = stretch.lookup_order();
    ids_.clear();
    for (const std::uint32_t n : order) ids_.push_back(stretch.vertices()[n]);
    const auto columns = function_.columns();
    gathered_.resize(columns.size() * ids_.size());
    mesh_.gather(ids_, columns, gathered_);
    std::vector<std::span<const double>> by_column;
    for (std::size_t k = 0; k < columns.size(); ++k)
      by_column.push_back(std::span(gathered_).subspan(k * ids_.size(), ids_.size()));
    ordered_.resize(ids_.size());
    if (numbering_ == Numbering::kOfInput) mesh_.to_original(ids_);
    function_.evaluate(ids_, by_column, ordered_);
    values_.resize(ids_.size());
    for (std::size_t i = 0; i < order.size(); ++i) values_[order[i]] = ordered_[i];
    return values_;
  }

 private:
  IndexedMesh& mesh_;
  VertexFunction& function_;
  Numbering numbering_;
  std::vector<VertexId> ids_;
  std::vector<double> gathered_, ordered_, values_;
};

// Triangle t of a stretch.
KeyedTriangle keyed(const TriangleStretches& stretch, std::size_t t, std::span<const double> values) {
  const auto corners = stretch.corners().subspan(3 * t, 3);
  const auto numbers = stretch.numbers().subspan(3 * t, 3);
  SweepKey highest{values[numbers[0]], corners[0]};
  for (std::size_t c = 1; c < 3; ++c) {
    const SweepKey key{values[numbers[c]], corners[c]};
    if (highest < key) highest = key;
  }
  return {highest.value,
          highest.vertex.value(),
          stretch.first_triangle() + t,
          {corners[0].value(), corners[1].value(), corners[2].value()}};
}

// The values of a table, as a function.
class TableFunction : public VertexFunction {
 public:
  explicit TableFunction(VertexNumbers& values) : values_(values) {}
  std::string name() const override { return "spectral"; }
  std::span<const unsigned> columns() const override { return {}; }
  void evaluate(std::span<const VertexId> ids, std::span<const std::span<const double>> /*columns*/,
                std::span<double> values) override {
    for (std::size_t i = 0; i < ids.size(); ++i) values[i] = values_.get(ids[i].value());
  }

 private:
  VertexNumbers& values_;
};

std::unique_ptr<IndexedMesh> sorted_by(std::unique_ptr<IndexedMesh> mesh, VertexFunction& function, Numbering numbering,
                                       Workspace& space, const SortProgress& progress) {
  auto ordered = std::make_unique<OrderedMesh>(std::move(mesh), space);
  SortOptions sorting;
  sorting.allowance_bytes = space.share();
  ExternalSort<KeyedTriangle> sort("triangle order", space.temp, space.budget, sorting);
  constexpr double kMerged = 0.7;  // of the time, about
  const auto tell = [&](double done) {
    if (progress) progress(done);
  };
  std::uint64_t triangles = 0, appended = 0;
  StretchValues values_of(ordered->vertices(), function, numbering);
  for (TriangleStretches stretch("triangle order", ordered->vertices(), space); stretch.next();) {
    const auto values = values_of(stretch);
    for (std::size_t t = 0; t < stretch.corners().size() / 3; ++t) sort.add(keyed(stretch, t, values));
    triangles += stretch.corners().size() / 3;
    const IndexedMesh& from = ordered->vertices();
    tell(kMerged * static_cast<double>(from.bytes_read()) /
         static_cast<double>(std::max<std::uint64_t>(from.bytes_total(), 1)));
  }
  sort.finish();
  std::vector<VertexId> corners;
  for (std::vector<KeyedTriangle> some; sort.read(some, kKeyedAtOnce);) {
    corners.clear();
    for (const KeyedTriangle& triangle : some)
      for (const std::uint64_t corner : triangle.corners) corners.emplace_back(corner);
    ordered->append(corners);
    appended += some.size();
    tell(kMerged + (1 - kMerged) * static_cast<double>(appended) / static_cast<double>(triangles));
  }
  return ordered;
}

}  // namespace

std::unique_ptr<IndexedMesh> sorted_by_function(std::unique_ptr<IndexedMesh> mesh, VertexFunction& function,
                                                Workspace& space, const SortProgress& progress) {
  return sorted_by(std::move(mesh), function, Numbering::kOfInput, space, progress);
}

std::unique_ptr<IndexedMesh> sorted_along_hilbert(std::unique_ptr<IndexedMesh> mesh, unsigned dimension,
                                                  Workspace& space, const SortProgress& progress) {
  ReorderOptions options;
  options.allowance_bytes = 2 * space.share();
  options.coordinates = dimension;
  options.threads = machine_threads();
  options.progress = progress;
  return reorder(*mesh, space.temp, space.budget, options);
}

std::unique_ptr<IndexedMesh> sorted_by_spectrum(std::unique_ptr<IndexedMesh> mesh, unsigned dimension, Workspace& space,
                                                const SortProgress& progress) {
  constexpr double kCoherent = 0.25, kVector = 0.85;  // of the time, about
  const auto part = [&progress](double from, double to) {
    return [&progress, from, to](double done) {
      if (progress) progress(from + (to - from) * done);
    };
  };
  auto coherent = sorted_along_hilbert(std::move(mesh), dimension, space, part(0, kCoherent));
  VertexNumbers values = fiedler_vector(*coherent, space);
  TableFunction function(values);
  return sorted_by(std::move(coherent), function, Numbering::kOfMesh, space, part(kVector, 1));
}

}  // namespace reeb::ooc
