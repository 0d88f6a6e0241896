#include "ooc/grids/grid_chunks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "io/file/checksum.h"
#include "libreeb/base/error.h"
#include "libreeb/grid/grid_boxes.h"

namespace reeb::ooc {
namespace {

// The axes of more than one vertex: a layer of boxes is cut across the last of them.
struct Axes {
  explicit Axes(const GridSize& grid) {
    for (std::size_t k = 0; k < 3; ++k)
      if (grid[k] > 1) {
        ++count;
        last = k;
      }
  }
  unsigned count = 0;
  std::size_t last = 2;
};

std::array<std::uint32_t, 3> box_cells(const GridSize& grid, std::size_t box_vertices, std::uint64_t layer_bytes,
                                       std::size_t functions) {
  const Axes axes(grid);
  const double side = std::pow(static_cast<double>(box_vertices), 1.0 / std::max(axes.count, 1u));
  const auto cells = static_cast<std::uint32_t>(std::max(1.0, std::floor(side + 1e-9)));
  std::array<std::uint32_t, 3> box{cells, cells, cells};
  std::uint64_t slice = 1;
  for (std::size_t k = 0; k < axes.last; ++k) slice *= grid[k];
  const std::uint64_t slices = layer_bytes / (slice * sizeof(double) * functions);
  box[axes.last] = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(slices, 2, std::uint64_t{cells} + 1) - 1);
  return box;
}

class GridChunks : public ChunkSource {
 public:
  GridChunks(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget, std::size_t box_vertices,
             const ChunkPlace& start)
      : reader_(reader),
        functions_(functions),
        grid_(reader.info().grid->size),
        layer_axis_(Axes(grid_).last),
        boxes_(grid_, box_cells(grid_, box_vertices, budget.free_bytes() / 4, functions.function_count())),
        reservation_(budget.reserve("layer of the image", 0)),
        layer_(functions.function_count()),
        batch_values_(functions.function_count()) {
    for (std::size_t k = 0; k < layer_axis_; ++k) slice_ *= grid_[k];
    reservation_.resize(functions.function_count() * sizeof(double) * slice_ * boxes_.size(layer_axis_, 0));
    pass_over(start);
  }

  bool next(WorkItem& item) override;
  std::uint64_t bytes_read() const override { return reader_.bytes_read(); }
  std::uint64_t bytes_total() const override { return reader_.info().file_bytes; }
  std::uint64_t triangles_read() const override { return simplices_listed()[Axes(grid_).count]; }
  SimplexCounts simplices_listed() const override;
  std::uint64_t vertex_count() const override { return vertices_; }

 private:
  void pass_over(const ChunkPlace& start);
  bool read_layer();
  void read_vertices(std::uint64_t count);
  bool read_batch();
  void fill(WorkItem& item) const;
  bool move_on();

  MeshReader& reader_;
  FunctionValues& functions_;
  GridSize grid_;
  std::size_t layer_axis_;
  GridBoxes boxes_;
  Reservation reservation_;
  std::uint64_t slice_ = 1;   // vertices of a slice across that axis
  std::uint64_t layers_ = 0;  // read so far
  std::uint64_t vertices_ = 0;
  std::vector<std::vector<double>> layer_;  // values by function
  std::array<std::uint64_t, 3> box_{};      // the next one
  bool in_layer_ = false;
  io::RunningDigest digest_;

  MeshBatch batch_;
  std::size_t taken_ = 0;  // vertices of the batch that are in a layer
  std::vector<VertexId> ids_;
  std::vector<std::span<const double>> data_;
  std::vector<Point> positions_;
  std::vector<std::vector<double>> batch_values_;
};

bool GridChunks::next(WorkItem& item) {
  if (!in_layer_ && !read_layer()) return false;
  boxes_.fill(box_, item.chunk);
  fill(item);
  in_layer_ = move_on();
  item.can_resume_after = !in_layer_;
  item.end = {.triangles = triangles_read(),
              .next_vertex = vertices_,
              .batches = layers_,
              .digest = digest_.value(),
              .ranges = functions_.ranges()};
  return true;
}

// Values of vertices beyond the layers before `start` count as read, as they did in the earlier run.
void GridChunks::pass_over(const ChunkPlace& start) {
  while (layers_ < start.batches && read_layer()) continue;
  in_layer_ = false;
  if (layers_ != start.batches || vertices_ != start.next_vertex || (layers_ != 0 && digest_.value() != start.digest))
    throw InputChanged();
  if (!start.ranges.empty()) functions_.set_ranges(start.ranges);
}

// The last slice of a layer is the first one of the next.
bool GridChunks::read_layer() {
  if (layers_ == boxes_.count(layer_axis_)) return false;
  const std::uint64_t size = slice_ * boxes_.size(layer_axis_, layers_);
  for (auto& values : layer_) {
    if (layers_ != 0) values.erase(values.begin(), values.end() - static_cast<std::ptrdiff_t>(slice_));
    values.reserve(size);
  }
  read_vertices(size - layer_[0].size());
  box_ = {};
  box_[layer_axis_] = layers_++;
  return in_layer_ = true;
}

void GridChunks::read_vertices(std::uint64_t count) {
  while (count != 0) {
    if (taken_ == batch_.vertex_count && !read_batch()) throw InputChanged();
    const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(count, batch_.vertex_count - taken_));
    for (std::size_t f = 0; f < layer_.size(); ++f) {
      const auto first = batch_values_[f].begin() + static_cast<std::ptrdiff_t>(taken_);
      layer_[f].insert(layer_[f].end(), first, first + static_cast<std::ptrdiff_t>(piece));
    }
    taken_ += piece;
    vertices_ += piece;
    count -= piece;
  }
}

bool GridChunks::read_batch() {
  taken_ = 0;
  if (!reader_.read(batch_)) return false;
  const std::size_t n = batch_.vertex_count;
  ids_.resize(n);
  for (std::size_t i = 0; i < n; ++i) ids_[i] = VertexId(batch_.first_vertex.value() + i);
  data_.clear();
  for (const unsigned column : functions_.columns()) data_.emplace_back(batch_.column(column));
  positions_.clear();
  for (auto& values : batch_values_) values.clear();
  functions_.evaluate(ids_, data_, positions_, batch_values_);
  for (const auto& values : batch_values_) digest_.add(std::as_bytes(std::span(values)));
  return true;
}

// Values are copied row by row, and positions follow from the grid.
void GridChunks::fill(WorkItem& item) const {
  const Chunk& chunk = item.chunk;
  const GridInfo& grid = *reader_.info().grid;
  std::array<std::uint64_t, 3> first{};
  for (std::size_t k = 0; k < 3; ++k) first[k] = boxes_.first(k, box_[k]);
  item.values.resize(layer_.size());
  for (auto& values : item.values) values.clear();
  item.chunk.positions.resize(chunk.vertex_count());
  auto position = item.chunk.positions.begin();
  for (std::uint64_t k = 0; k < chunk.box[2]; ++k)
    for (std::uint64_t j = 0; j < chunk.box[1]; ++j) {
      std::array<std::uint64_t, 3> in_layer{first[0], first[1] + j, first[2] + k};
      in_layer[layer_axis_] -= first[layer_axis_];
      const std::uint64_t row = in_layer[0] + grid_[0] * (in_layer[1] + grid_[1] * in_layer[2]);
      for (std::size_t f = 0; f < layer_.size(); ++f) {
        const auto from = layer_[f].begin() + static_cast<std::ptrdiff_t>(row);
        item.values[f].insert(item.values[f].end(), from, from + chunk.box[0]);
      }
      for (std::uint64_t i = 0; i < chunk.box[0]; ++i, ++position) {
        *position = {};
        for (std::size_t axis = 0; axis < grid.axes; ++axis)
          (*position)[axis] = grid.coordinate(axis, {first[0] + i, first[1] + j, first[2] + k});
      }
    }
}

// To the next box of the layer; false at its end.
bool GridChunks::move_on() {
  for (std::size_t axis = 0; axis < layer_axis_; ++axis) {
    if (++box_[axis] < boxes_.count(axis)) return true;
    box_[axis] = 0;
  }
  return false;
}

// Those of the highest dimension.
SimplexCounts GridChunks::simplices_listed() const {
  constexpr std::array<std::uint64_t, 4> kPerCell{0, 1, 2, 6};
  const unsigned axes = Axes(grid_).count;
  const std::uint64_t slices = vertices_ / slice_;
  std::uint64_t cells = slices == 0 ? 0 : slices - 1;
  for (std::size_t k = 0; k < layer_axis_; ++k) cells *= std::max<std::uint64_t>(grid_[k] - 1, 1);
  SimplexCounts counts{};
  counts[axes] = kPerCell[axes] * cells;
  return counts;
}

}  // namespace

std::unique_ptr<ChunkSource> chunks_of_grid(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget,
                                            std::size_t box_vertices, const ChunkPlace& start) {
  return std::make_unique<GridChunks>(reader, functions, budget, box_vertices, start);
}

}  // namespace reeb::ooc
