#include "io/generate/generator.h"

#include <algorithm>
#include <array>
#include <utility>

#include "io/generate/ball.h"
#include "io/generate/permutation.h"
#include "io/generate/shape.h"
#include "io/generate/sierpinski.h"
#include "io/generate/surfaces.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::uint64_t kMaxTriangles = std::uint64_t{1} << 42;  // or tetrahedra
constexpr std::uint64_t kMaxHandles = kMaxTriangles / 64;        // at least 48 tetrahedra each

template <class Value>
using Names = std::pair<std::string_view, Value>;

constexpr std::array<Names<MeshKind>, 7> kKinds = {{{"torus", MeshKind::kTorus},
                                                    {"terrain", MeshKind::kTerrain},
                                                    {"grid", MeshKind::kGrid},
                                                    {"plate", MeshKind::kPlate},
                                                    {"scan", MeshKind::kScan},
                                                    {"sierpinski", MeshKind::kSierpinski},
                                                    {"ball", MeshKind::kBall}}};
constexpr std::array<Names<MeshOrder>, 6> kOrders = {{{"rows", MeshOrder::kRows},
                                                      {"patches", MeshOrder::kPatches},
                                                      {"random", MeshOrder::kRandom},
                                                      {"tiles:N", MeshOrder::kTiles},
                                                      {"random-tiles:N", MeshOrder::kRandomTiles},
                                                      {"seams-last:N", MeshOrder::kSeamsLast}}};

bool has_tiles(MeshOrder order) { return order >= MeshOrder::kTiles; }

template <class Table>
[[noreturn]] void fail_unknown(const Table& table, std::string_view what, std::string_view name,
                               std::string_view also = "") {
  std::string known;
  for (const auto& [entry, value] : table) known += (known.empty() ? "" : ", ") + std::string(entry);
  known += also;
  throw Error(ErrorKind::kUsage, "unknown " + std::string(what) + " '" + std::string(name) + "'",
              "choose one of " + known);
}

// Sets `count` if the text is a number from 1 on.
bool read_count(std::string_view text, std::uint64_t& count) {
  const auto value = whole_number<std::uint64_t>(text);
  if (!value || *value == 0) return false;
  count = *value;
  return true;
}

template <class Table, class Value>
std::string name_of(const Table& table, Value value) {
  const auto it =
      std::find_if(table.begin(), table.end(), [value](const auto& entry) { return entry.second == value; });
  return std::string(it->first);
}

// Delivers all vertices, then all triangles.
class ShapeReader : public GeneratedMesh {
 public:
  ShapeReader(std::unique_ptr<Shape> shape, const GeneratorOptions& options, std::size_t batch_events)
      : shape_(std::move(shape)),
        topology_(shape_->topology()),
        order_(options.order),
        permutation_(permuted(), options.seed),
        batch_events_(std::max<std::size_t>(batch_events, 1)) {
    info_.format = "generated " + name_of(kKinds, options.kind);
    info_.dimension = shape_->dimension();
    info_.vertex_count = topology_.vertices;
    info_.simplex_count = shape_->simplex_corners() != 0 ? shape_->cell_count() : topology_.triangles;
  }

  const MeshInfo& info() const override { return info_; }
  const ExpectedTopology& topology() const override { return topology_; }
  std::uint64_t bytes_read() const override { return 0; }

  bool read(MeshBatch& batch) override {
    batch.clear();
    batch.first_vertex = VertexId(next_vertex_);
    if (next_vertex_ < topology_.vertices)
      read_vertices(batch);
    else if (shape_->simplex_corners() != 0)
      read_simplices(batch);
    else if (order_ == MeshOrder::kRandom)
      read_random_triangles(batch);
    else
      read_cells(batch);
    return !batch.empty();
  }

 private:
  void read_vertices(MeshBatch& batch) {
    batch.vertex_count =
        static_cast<std::size_t>(std::min<std::uint64_t>(batch_events_, topology_.vertices - next_vertex_));
    batch.coordinates.resize(info_.dimension);
    shape_->append_vertices(next_vertex_, batch.vertex_count, batch.coordinates);
    next_vertex_ += batch.vertex_count;
  }

  std::uint64_t permuted() const {
    if (order_ == MeshOrder::kRandomTiles) return shape_->tile_count();
    return shape_->simplex_corners() != 0 ? shape_->cell_count() : topology_.triangles;
  }

  void read_simplices(MeshBatch& batch) {
    const std::uint64_t end = std::min<std::uint64_t>(shape_->cell_count(), next_ + batch_events_);
    for (; next_ < end; ++next_)
      shape_->append_cell(order_ == MeshOrder::kRandom ? permutation_(next_) : next_,
                          batch.simplices[shape_->simplex_corners() - 1]);
  }

  void read_random_triangles(MeshBatch& batch) {
    for (; batch.triangle_count() < batch_events_ && next_ < topology_.triangles; ++next_)
      shape_->append_triangle(permutation_(next_), batch.triangles());
  }

  // A cell can have more triangles than the batch has room for; the rest waits for the next batch.
  void read_cells(MeshBatch& batch) {
    batch.triangles().swap(waiting_);
    while (batch.triangle_count() < batch_events_ && find_cell()) {
      const bool seams_come_last = order_ == MeshOrder::kSeamsLast;
      if (!seams_come_last || shape_->is_seam(next_) == at_seams_) shape_->append_cell(next_, batch.triangles());
      ++next_;
    }
    const std::size_t end = std::min(batch.triangles().size(), 3 * batch_events_);
    const auto rest = batch.triangles().begin() + static_cast<std::ptrdiff_t>(end);
    waiting_.assign(rest, batch.triangles().end());
    batch.triangles().erase(rest, batch.triangles().end());
  }

  // Moves next_ to the first cell of the next tile at the end of a tile. False after the last one.
  bool find_cell() {
    while (next_ == tile_end_) {
      if (tile_ == shape_->tile_count()) {
        if (order_ != MeshOrder::kSeamsLast || at_seams_) return false;
        at_seams_ = true;
        tile_ = 0;
      }
      const std::uint64_t tile = order_ == MeshOrder::kRandomTiles ? permutation_(tile_) : tile_;
      ++tile_;
      next_ = shape_->tile_begin(tile);
      tile_end_ = shape_->tile_begin(tile + 1);
    }
    return true;
  }

  std::unique_ptr<Shape> shape_;
  ExpectedTopology topology_;
  MeshInfo info_;
  MeshOrder order_;
  Permutation permutation_;
  std::size_t batch_events_;
  std::uint64_t next_vertex_ = 0;
  std::uint64_t next_ = 0;  // cell, or index in the random order
  std::uint64_t tile_ = 0, tile_end_ = 0;
  bool at_seams_ = false;
  std::vector<VertexId> waiting_;
};

std::unique_ptr<Shape> make_ball(const GeneratorOptions& options) {
  if (options.tetrahedra == 0 || options.tetrahedra > kMaxTriangles)
    throw Error(ErrorKind::kUsage, "cannot generate " + std::to_string(options.tetrahedra) + " tetrahedra",
                "choose --tetrahedra between 1 and " + std::to_string(kMaxTriangles));
  if (options.handles > kMaxHandles)
    throw Error(ErrorKind::kUsage, "cannot generate " + std::to_string(options.handles) + " handles",
                "choose --handles up to " + std::to_string(kMaxHandles));
  if (has_tiles(options.order))
    throw Error(ErrorKind::kUsage, "a ball has no tiles", "choose --order rows, patches or random");
  return std::make_unique<DrilledBall>(options.tetrahedra, options.handles);
}

std::unique_ptr<Shape> make_shape(const GeneratorOptions& options) {
  if (options.kind == MeshKind::kBall) return make_ball(options);
  if (options.triangles == 0 || options.triangles > kMaxTriangles)
    throw Error(ErrorKind::kUsage, "cannot generate " + std::to_string(options.triangles) + " triangles",
                "choose --triangles between 1 and " + std::to_string(kMaxTriangles));
  if (options.tile_cells == 0) throw Error(ErrorKind::kUsage, "a tile without cells", "choose at least 1");
  if (options.kind != MeshKind::kSierpinski) return make_grid_surface(options);
  if (has_tiles(options.order))
    throw Error(ErrorKind::kUsage, "a Sierpinski simplex has no tiles", "choose --order rows, patches or random");
  if (options.dimension < SierpinskiSimplex::kMinDimension || options.dimension > SierpinskiSimplex::kMaxDimension)
    throw Error(ErrorKind::kUsage, "no Sierpinski simplex of dimension " + std::to_string(options.dimension),
                "choose --dimension 2, 3, 4 or 5");
  return std::make_unique<SierpinskiSimplex>(options.dimension, options.triangles, options.whole_cells);
}

}  // namespace

std::unique_ptr<GeneratedMesh> generate_mesh(const GeneratorOptions& options, const ReadOptions& read_options) {
  if (!read_options.properties.empty())
    throw Error(ErrorKind::kBadInput, "the mesh has no vertex property \"" + read_options.properties.front() + "\"",
                "generated meshes have coordinates only");
  return std::make_unique<ShapeReader>(make_shape(options), options, read_options.batch_events);
}

MeshKind mesh_kind(std::string_view name) {
  for (const auto& [known, kind] : kKinds)
    if (known == name) return kind;
  fail_unknown(kKinds, "kind of mesh", name, ", volume");  // which is an image (volume.h)
}

void set_order(GeneratorOptions& options, std::string_view name) {
  for (const auto& [form, order] : kOrders) {
    const std::string_view start = form.substr(0, form.size() - (has_tiles(order) ? 1 : 0));  // without N
    if (!name.starts_with(start)) continue;
    const std::string_view rest = name.substr(start.size());
    if (has_tiles(order) ? !read_count(rest, options.tile_cells) : !rest.empty()) continue;
    options.order = order;
    return;
  }
  fail_unknown(kOrders, "order", name);
}

}  // namespace reeb::io
