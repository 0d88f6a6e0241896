// The layers of slices of a grid, one after the other, with the values of functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/file/checksum.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/grid/grid_boxes.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/function_values.h"

namespace reeb::ooc {

// The axes of a grid that have more than one vertex. A layer of boxes is cut across the last of them.
struct GridAxes {
  explicit GridAxes(const GridSize& grid) {
    for (std::size_t k = 0; k < 3; ++k)
      if (grid[k] > 1) {
        ++count;
        last = k;
      }
  }
  unsigned count = 0;
  std::size_t last = 2;
};

// Cells of a box along each axis, so that it has at most about `box_vertices`, and a layer of boxes at most
// `layer_bytes`, or two slices.
std::array<std::uint32_t, 3> box_cells(const GridSize& grid, std::size_t box_vertices, std::uint64_t layer_bytes,
                                       std::size_t functions);

// MEMORY: reserved: the values of a layer, at least two slices.
class GridLayers {
 public:
  // A run that is resumed at `start` has the boxes that it began with.
  // REQUIRES: the reader leaves out simplices. THROWS: Error{kResource} of the budget; DamagedState.
  GridLayers(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget, std::size_t box_vertices,
             const ChunkPlace& start);

  // The next layer; false at the end. The last slice of a layer is the first one of the next.
  // THROWS: Error{kChanged} if the grid ends early.
  bool read();
  // The values in the layer, by function; NaN where a vertex is left out.
  const std::vector<std::vector<double>>& values() const { return values_; }
  const GridBoxes& boxes() const { return boxes_; }
  std::size_t axis() const { return axis_; }       // along which layers follow each other
  std::uint64_t slice() const { return slice_; }   // vertices of a slice
  std::uint64_t count() const { return layers_; }  // read so far
  std::uint64_t slices_before() const { return boxes_.first(axis_, layers_ - 1); }  // before the layer
  bool is_last() const { return layers_ == boxes_.count(axis_); }
  // That are not left out, in all layers so far.
  std::uint64_t vertices() const { return vertices_; }
  // The place after the layer. Values of vertices beyond it count as read.
  ChunkPlace end(std::uint64_t triangles) const;
  // Whether this is the place after the layer.
  bool is_at(const ChunkPlace& place) const;
  // The positions of the vertices of a box, and one array of values for each function. `from` has their indices in the
  // layer.
  void copy(std::span<const std::uint64_t> from, WorkItem& item) const;

 private:
  void read_vertices(std::uint64_t next, std::uint64_t end);
  void leave_out_until(std::uint64_t place);
  bool read_batch();

  MeshReader& reader_;
  FunctionValues& functions_;
  GridSize grid_;
  std::size_t axis_;
  std::array<std::uint32_t, 3> cells_;  // of a box
  GridBoxes boxes_;
  Reservation reservation_;
  std::uint64_t slice_ = 1, layers_ = 0, vertices_ = 0;
  std::vector<std::vector<double>> values_;
  io::RunningDigest digest_;

  MeshBatch batch_;
  std::size_t taken_ = 0;  // vertices of the batch that are in a layer
  bool ended_ = false;     // the reader has no more
  std::vector<Point> positions_;
  std::vector<std::vector<double>> batch_values_;
};

}  // namespace reeb::ooc
