#include "ooc/grids/grid_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libreeb/base/error.h"
#include "libreeb/base/state_stream.h"

namespace reeb::ooc {
namespace {

// The cells of a box in one number.
constexpr unsigned kCellBits = 21;
constexpr double kMostCells = (1u << kCellBits) - 1;

std::uint64_t pack(const std::array<std::uint32_t, 3>& cells) {
  return cells[0] | std::uint64_t{cells[1]} << kCellBits | std::uint64_t{cells[2]} << (2 * kCellBits);
}

std::array<std::uint32_t, 3> unpack(std::uint64_t packed) {
  std::array<std::uint32_t, 3> cells{};
  for (std::uint32_t& n : cells) {
    n = static_cast<std::uint32_t>(packed & ((1u << kCellBits) - 1));
    packed >>= kCellBits;
    if (n == 0) throw DamagedState();
  }
  return cells;
}

// What a header announces can be more bytes than 64 bits count. The most that they count is refused, too.
std::uint64_t saturating_times(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t kMost = ~std::uint64_t{0};
  return b != 0 && a > kMost / b ? kMost : a * b;
}

}  // namespace

std::array<std::uint32_t, 3> box_cells(const GridSize& grid, std::size_t box_vertices, std::uint64_t layer_bytes,
                                       std::size_t functions) {
  const GridAxes axes(grid);
  const double side = std::pow(static_cast<double>(box_vertices), 1.0 / std::max(axes.count, 1u));
  const auto cells = static_cast<std::uint32_t>(std::clamp(std::floor(side + 1e-9), 1.0, kMostCells));
  std::array<std::uint32_t, 3> box{cells, cells, cells};
  std::uint64_t slice = 1;
  for (std::size_t k = 0; k < axes.last; ++k) slice *= grid[k];
  const std::uint64_t slices = layer_bytes / saturating_times(slice, sizeof(double) * functions);
  box[axes.last] = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(slices, 2, std::uint64_t{cells} + 1) - 1);
  return box;
}

GridLayers::GridLayers(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget, std::size_t box_vertices,
                       const ChunkPlace& start)
    : reader_(reader),
      functions_(functions),
      grid_(reader.info().grid->size),
      axis_(GridAxes(grid_).last),
      cells_(start.chunk_blocks != 0
                 ? unpack(start.chunk_blocks)
                 : box_cells(grid_, box_vertices, budget.free_bytes() / 4, functions.function_count())),
      boxes_(grid_, cells_),
      reservation_(budget.reserve("layer of the image", 0)),
      values_(functions.function_count()),
      batch_values_(functions.function_count()) {
  for (std::size_t k = 0; k < axis_; ++k) slice_ *= grid_[k];
  const std::uint64_t slice_bytes = saturating_times(slice_, sizeof(double) * functions.function_count());
  reservation_.resize(saturating_times(slice_bytes, boxes_.size(axis_, 0)));
}

bool GridLayers::read() {
  if (is_last()) return false;
  const std::uint64_t size = slice_ * boxes_.size(axis_, layers_);
  for (auto& values : values_) {
    if (layers_ != 0) values.erase(values.begin(), values.end() - static_cast<std::ptrdiff_t>(slice_));
    values.reserve(size);
  }
  const std::uint64_t first = slice_ * boxes_.first(axis_, layers_);
  ++layers_;
  read_vertices(first + values_[0].size(), first + size);
  leave_out_until(size);
  return true;
}

// The vertices before this place in the layer that did not come. A layer grows as values arrive: until then, the memory
// for what a header announces is not touched.
void GridLayers::leave_out_until(std::uint64_t place) {
  for (auto& values : values_) values.resize(place, std::numeric_limits<double>::quiet_NaN());
}

// The vertices from `next` to `end` of the grid, but for those that the reader leaves out.
void GridLayers::read_vertices(std::uint64_t next, std::uint64_t end) {
  const std::uint64_t first = slice_ * slices_before();
  const bool has_all = reader_.info().vertex_count.has_value();
  while (next < end) {
    if (taken_ == batch_.vertex_count && !read_batch()) {
      if (has_all) throw input_changed();
      return;
    }
    const std::uint64_t id = batch_.first_vertex.value() + taken_;
    if (id < next || (has_all && id != next)) throw input_changed();
    if (id >= end) return;
    const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(end - id, batch_.vertex_count - taken_));
    leave_out_until(id - first);
    for (std::size_t f = 0; f < values_.size(); ++f) {
      const auto from = batch_values_[f].begin() + static_cast<std::ptrdiff_t>(taken_);
      values_[f].insert(values_[f].end(), from, from + static_cast<std::ptrdiff_t>(piece));
    }
    taken_ += piece;
    vertices_ += piece;
    next = id + piece;
  }
}

bool GridLayers::read_batch() {
  taken_ = 0;
  batch_.vertex_count = 0;
  if (ended_ || !reader_.read(batch_)) {
    ended_ = true;
    batch_.vertex_count = 0;
    return false;
  }
  functions_.evaluate(batch_, positions_, batch_values_);
  digest_.add(io::object_bytes(batch_.first_vertex.value()));
  for (const auto& values : batch_values_) digest_.add(std::as_bytes(std::span(values)));
  return true;
}

ChunkPlace GridLayers::end(std::uint64_t triangles) const {
  return {.triangles = triangles,
          .next_vertex = vertices_,
          .batches = layers_,
          .chunk_blocks = pack(cells_),
          .digest = digest_.value(),
          .ranges = functions_.ranges()};
}

bool GridLayers::is_at(const ChunkPlace& place) const {
  return layers_ == place.batches && vertices_ == place.next_vertex &&
         (layers_ == 0 || digest_.value() == place.digest);
}

// Positions follow from the grid.
void GridLayers::copy(std::span<const std::uint64_t> from, WorkItem& item) const {
  const GridInfo& grid = *reader_.info().grid;
  item.values.resize(values_.size());
  for (std::size_t f = 0; f < values_.size(); ++f) {
    item.values[f].clear();
    for (const std::uint64_t v : from) item.values[f].push_back(values_[f][v]);
  }
  item.chunk.positions.clear();
  const std::uint64_t before = slice_ * slices_before();
  for (const std::uint64_t v : from) {
    const std::uint64_t id = before + v;
    const std::array<std::uint64_t, 3> at{id % grid_[0], id / grid_[0] % grid_[1], id / grid_[0] / grid_[1]};
    Point position{};
    for (std::size_t axis = 0; axis < grid.axes; ++axis) position[axis] = grid.coordinate(axis, at);
    item.chunk.positions.push_back(position);
  }
}

}  // namespace reeb::ooc
