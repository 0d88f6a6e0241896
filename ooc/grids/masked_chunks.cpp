#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/grid/grid_division.h"
#include "libreeb/grid/masked_box.h"
#include "ooc/grids/grid_chunks.h"
#include "ooc/grids/grid_layers.h"

namespace reeb::ooc {
namespace {

// Counts the simplices of a grid that are in no larger one, slice by slice.
class ListedSimplices {
 public:
  explicit ListedSimplices(const GridSize& grid) {
    const GridAxes axes(grid);
    for (std::size_t k = 0; k < 3; ++k)
      if (grid[k] > 1) axes_ |= static_cast<std::uint8_t>(1u << k);
    across_ = static_cast<std::uint8_t>(1u << axes.last);
    size_ = {axes.last > 0 ? grid[0] : 1, axes.last > 1 ? grid[1] : 1};
    dimension_ = axes.count;
    for (const GridSimplex& simplex : grid_simplices(axes_, 2))
      kinds_.push_back({simplex, steps_to_cofaces(simplex, axes_)});
  }

  // Adds the simplices whose lowest corner is in `here`, of the slices below, here and above: whether each vertex is
  // there. An empty slice is beyond the grid.
  void add(std::span<const std::uint8_t> below, std::span<const std::uint8_t> here,
           std::span<const std::uint8_t> above) {
    const std::array<std::span<const std::uint8_t>, 3> slices{below, here, above};
    const auto has = [&](std::uint64_t v, unsigned up, unsigned down) {
      const auto slice = slices[(up & across_) != 0 ? 2 : (down & across_) != 0 ? 0 : 1];
      if (slice.empty()) return false;
      std::array<std::uint64_t, 2> at{v % size_[0], v / size_[0]};
      for (unsigned k = 0; k < 2; ++k) {
        if ((1u << k) == across_) continue;
        if ((up >> k & 1) != 0 && ++at[k] >= size_[k]) return false;
        if ((down >> k & 1) != 0 && at[k]-- == 0) return false;
      }
      return slice[at[0] + size_[0] * at[1]] != 0;
    };
    for (std::uint64_t v = 0; v < here.size(); ++v) {
      if (here[v] == 0) continue;
      bool has_cube = true;
      for (unsigned up = axes_; up != 0 && has_cube; up = (up - 1) & axes_) has_cube = has(v, up, 0);
      if (has_cube) {
        counts_[dimension_] += kPerCube[dimension_];
        continue;
      }
      for (const auto& [simplex, cofaces] : kinds_) {
        bool counts = true;
        for (std::size_t c = 1; c < simplex.corner_count && counts; ++c) counts = has(v, simplex.corners[c], 0);
        for (std::size_t i = 0; i < cofaces.size() && counts; ++i) counts = !has(v, cofaces[i].up, cofaces[i].down);
        if (counts) ++counts_[simplex.corner_count - 1u];
      }
    }
  }
  const SimplexCounts& counts() const { return counts_; }

 private:
  static constexpr std::array<std::uint64_t, 4> kPerCube{0, 1, 2, 6};
  struct Kind {
    GridSimplex simplex;
    std::vector<GridStep> cofaces;
  };

  std::uint8_t axes_ = 0, across_ = 0;
  std::array<std::uint64_t, 2> size_{1, 1};  // of a slice
  unsigned dimension_ = 0;
  std::vector<Kind> kinds_;
  SimplexCounts counts_{};
};

class MaskedChunks : public ChunkSource {
 public:
  MaskedChunks(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget, std::size_t box_triangles,
               const ChunkPlace& start)
      : reader_(reader),
        functions_(functions),
        grid_(reader.info().grid->size),
        boxes_(grid_),
        layers_(reader, functions, budget, std::max<std::size_t>(8, box_triangles / boxes_.triangles_per_vertex()),
                start),
        listed_(grid_),
        reservation_(budget.reserve("marks of a layer", 0)) {
    reservation_.resize(layers_.slice() * (layers_.boxes().size(layers_.axis(), 0) + 4));
    while (layers_.count() < start.batches && read_layer()) continue;
    if (!layers_.is_at(start)) throw input_changed();
    next_ = boxes_of_layer_.size();
    if (!start.ranges.empty()) functions_.set_ranges(start.ranges);
  }

  bool next(WorkItem& item) override {
    if (next_ == boxes_of_layer_.size() && !read_layer()) return false;
    boxes_.fill(layer_, boxes_of_layer_[next_++], shared_, item.chunk, from_);
    layers_.copy(from_, item);
    item.can_resume_after = next_ == boxes_of_layer_.size();
    item.end = layers_.end(triangles_read());
    return true;
  }
  std::uint64_t bytes_read() const override { return reader_.bytes_read(); }
  std::uint64_t bytes_total() const override { return reader_.info().file_bytes; }
  std::uint64_t triangles_read() const override {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : listed_.counts()) sum += count;
    return sum;
  }
  SimplexCounts simplices_listed() const override { return listed_.counts(); }
  std::uint64_t vertex_count() const override { return layers_.vertices(); }
  std::uint64_t vertex_bound() const override { return grid_[0] * grid_[1] * grid_[2]; }

 private:
  bool read_layer();
  void list_boxes();
  void count_simplices();
  std::vector<std::uint8_t> presence(std::uint64_t slice) const;

  MeshReader& reader_;
  FunctionValues& functions_;
  GridSize grid_;
  MaskedBoxes boxes_;
  GridLayers layers_;
  ListedSimplices listed_;
  Reservation reservation_;
  MaskedLayer layer_;
  std::vector<LayerBox> boxes_of_layer_;
  std::size_t next_ = 0;  // of them
  std::vector<std::uint8_t> shared_;
  std::vector<std::uint8_t> below_;  // presence in the slice before the layer
  std::vector<std::uint64_t> from_;
};

bool MaskedChunks::read_layer() {
  if (!layers_.read()) return false;
  const std::uint64_t slice = layers_.slice(), slices = layers_.values()[0].size() / slice;
  layer_.size = grid_;
  layer_.size[layers_.axis()] = slices;
  layer_.first_id = slice * layers_.slices_before();
  layer_.values.assign(layers_.values().begin(), layers_.values().end());
  // The last slice of the layer before is the first one of this.
  if (layers_.count() > 1)
    std::copy(shared_.end() - static_cast<std::ptrdiff_t>(slice), shared_.end(), shared_.begin());
  shared_.resize(slice * slices);
  std::fill(shared_.begin() + static_cast<std::ptrdiff_t>(layers_.count() > 1 ? slice : 0), shared_.end(),
            std::uint8_t{0});
  list_boxes();
  mark_shared_vertices(layer_, boxes_of_layer_, shared_);
  count_simplices();
  return true;
}

void MaskedChunks::list_boxes() {
  const GridBoxes& boxes = layers_.boxes();
  boxes_of_layer_.clear();
  next_ = 0;
  std::array<std::uint64_t, 3> end{boxes.count(0), boxes.count(1), boxes.count(2)}, begin{}, at{};
  begin[layers_.axis()] = layers_.count() - 1;
  end[layers_.axis()] = layers_.count();
  for (at[2] = begin[2]; at[2] < end[2]; ++at[2])
    for (at[1] = begin[1]; at[1] < end[1]; ++at[1])
      for (at[0] = begin[0]; at[0] < end[0]; ++at[0]) {
        LayerBox box;
        box.shared = boxes.shared_faces(at);
        for (std::size_t k = 0; k < 3; ++k) {
          box.first[k] = k == layers_.axis() ? 0 : boxes.first(k, at[k]);
          box.size[k] = boxes.size(k, at[k]);
        }
        boxes_of_layer_.push_back(box);
      }
}

std::vector<std::uint8_t> MaskedChunks::presence(std::uint64_t slice) const {
  std::vector<std::uint8_t> present(layers_.slice());
  for (std::uint64_t v = 0; v < present.size(); ++v) present[v] = layer_.has(slice * present.size() + v) ? 1 : 0;
  return present;
}

// Those whose lowest corner is in the last slice are counted with the next layer.
void MaskedChunks::count_simplices() {
  const std::uint64_t slices = layer_.size[layers_.axis()];
  std::vector<std::uint8_t> here = presence(0), above;
  for (std::uint64_t slice = 0; slice < slices; ++slice) {
    const bool is_last = slice + 1 == slices;
    if (is_last && !layers_.is_last()) return;
    above = is_last ? std::vector<std::uint8_t>() : presence(slice + 1);
    listed_.add(below_, here, above);
    below_ = std::exchange(here, std::move(above));
  }
}

}  // namespace

std::unique_ptr<ChunkSource> chunks_of_masked_grid(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget,
                                                   std::size_t box_triangles, const ChunkPlace& start) {
  return std::make_unique<MaskedChunks>(reader, functions, budget, box_triangles, start);
}

}  // namespace reeb::ooc
