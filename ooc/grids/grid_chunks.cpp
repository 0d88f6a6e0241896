#include "ooc/grids/grid_chunks.h"

#include <algorithm>
#include <array>
#include <vector>

#include "libreeb/base/error.h"
#include "ooc/grids/grid_layers.h"

namespace reeb::ooc {
namespace {

class GridChunks : public ChunkSource {
 public:
  GridChunks(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget, std::size_t box_vertices,
             const ChunkPlace& start)
      : reader_(reader),
        functions_(functions),
        grid_(reader.info().grid->size),
        layers_(reader, functions, budget, box_vertices, start) {
    pass_over(start);
  }

  bool next(WorkItem& item) override;
  std::uint64_t bytes_read() const override { return reader_.bytes_read(); }
  std::uint64_t bytes_total() const override { return reader_.info().file_bytes; }
  std::uint64_t triangles_read() const override { return simplices_listed()[GridAxes(grid_).count]; }
  SimplexCounts simplices_listed() const override;
  std::uint64_t vertex_count() const override { return layers_.vertices(); }

 private:
  void pass_over(const ChunkPlace& start);
  bool read_layer();
  void fill(WorkItem& item) const;
  bool move_on();

  MeshReader& reader_;
  FunctionValues& functions_;
  GridSize grid_;
  GridLayers layers_;
  std::array<std::uint64_t, 3> box_{};  // the next one
  bool in_layer_ = false;
};

bool GridChunks::next(WorkItem& item) {
  if (!in_layer_ && !read_layer()) return false;
  layers_.boxes().fill(box_, item.chunk);
  fill(item);
  in_layer_ = move_on();
  item.can_resume_after = !in_layer_;
  item.end = layers_.end(triangles_read());
  return true;
}

// Values of vertices beyond the layers before `start` count as read, as they did in the earlier run.
void GridChunks::pass_over(const ChunkPlace& start) {
  while (layers_.count() < start.batches && layers_.read()) continue;
  if (!layers_.is_at(start)) throw input_changed();
  if (!start.ranges.empty()) functions_.set_ranges(start.ranges);
}

bool GridChunks::read_layer() {
  if (!layers_.read()) return false;
  box_ = {};
  box_[layers_.axis()] = layers_.count() - 1;
  return in_layer_ = true;
}

// Values are copied row by row, and positions follow from the grid.
void GridChunks::fill(WorkItem& item) const {
  const Chunk& chunk = item.chunk;
  const GridInfo& grid = *reader_.info().grid;
  std::array<std::uint64_t, 3> first{};
  for (std::size_t k = 0; k < 3; ++k) first[k] = layers_.boxes().first(k, box_[k]);
  item.values.resize(layers_.values().size());
  for (auto& values : item.values) values.clear();
  item.chunk.positions.resize(chunk.vertex_count());
  auto position = item.chunk.positions.begin();
  for (std::uint64_t k = 0; k < chunk.box[2]; ++k)
    for (std::uint64_t j = 0; j < chunk.box[1]; ++j) {
      std::array<std::uint64_t, 3> in_layer{first[0], first[1] + j, first[2] + k};
      in_layer[layers_.axis()] -= first[layers_.axis()];
      const std::uint64_t row = in_layer[0] + grid_[0] * (in_layer[1] + grid_[1] * in_layer[2]);
      for (std::size_t f = 0; f < layers_.values().size(); ++f) {
        const auto from = layers_.values()[f].begin() + static_cast<std::ptrdiff_t>(row);
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
  for (std::size_t axis = 0; axis < layers_.axis(); ++axis) {
    if (++box_[axis] < layers_.boxes().count(axis)) return true;
    box_[axis] = 0;
  }
  return false;
}

// Those of the highest dimension.
SimplexCounts GridChunks::simplices_listed() const {
  constexpr std::array<std::uint64_t, 4> kPerCell{0, 1, 2, 6};
  const unsigned axes = GridAxes(grid_).count;
  const std::uint64_t slices = layers_.vertices() / layers_.slice();
  std::uint64_t cells = slices == 0 ? 0 : slices - 1;
  for (std::size_t k = 0; k < layers_.axis(); ++k) cells *= std::max<std::uint64_t>(grid_[k] - 1, 1);
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
