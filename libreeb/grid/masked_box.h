// Boxes of a grid of which some vertices are left out, as chunks of triangles (docs/ARCHITECTURE.md, Grids).
//
// Two boxes have a common face, which is a complex F. Points of F that are on one contour of F are on one contour of
// each box. So for each contour of F one point decides. Hence few vertices of F are shared: those that a box needs as
// nodes, and those on a few rising paths of edges that meet every contour of F. The other vertices of F are regular in
// every box. They are used in the box alone, and counted in the last box that has them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/grid/grid_boxes.h"
#include "libreeb/sweep/chunk.h"

namespace reeb {

// Consecutive slices of a grid along its last axis of more than one vertex. Vertex (i, j, k) of the layer has the index
// i + size[0] * (j + size[1] * k) in `values`, and `first_id` more in the grid.
struct MaskedLayer {
  GridSize size;
  std::uint64_t first_id = 0;
  std::vector<std::span<const double>> values;  // one per function; NaN in all of them: the vertex is left out

  bool has(std::uint64_t v) const { return values[0][v] == values[0][v]; }
  std::uint64_t index(const std::array<std::uint64_t, 3>& at) const {
    return at[0] + size[0] * (at[1] + size[1] * at[2]);
  }
};

// A box of the layer.
struct LayerBox {
  std::array<std::uint64_t, 3> first{};  // in the layer
  BoxSize size{};
  BoxFaces shared = 0;  // that other boxes have, too, also those of other layers
};

// Marks, in `shared`, the vertices of the layer that its boxes share. On entry the vertices of the first slice have the
// marks that they got in the layer before; all others have none.
//
// TIME: proportional to the vertices on faces, and to the length of the paths.
void mark_shared_vertices(const MaskedLayer& layer, std::span<const LayerBox> boxes, std::vector<std::uint8_t>& shared);

// Fills chunks with boxes.
//
// MEMORY: 4 bytes per vertex of a box.
class MaskedBoxes {
 public:
  explicit MaskedBoxes(const GridSize& grid);

  // Triangles per vertex, about.
  std::size_t triangles_per_vertex() const { return triangles_.empty() ? 1 : triangles_.size(); }
  // Replaces `chunk`, without positions, by the box: its vertices, all triangles, and the edges that have none.
  // `from[i]` becomes the index in the layer of local vertex i.
  void fill(const MaskedLayer& layer, const LayerBox& box, std::span<const std::uint8_t> shared, Chunk& chunk,
            std::vector<std::uint64_t>& from);

 private:
  using Step = std::array<int, 3>;
  struct Edge {
    Step to;
    std::vector<Step> apexes;  // of the triangles at the edge
  };

  std::vector<std::array<Step, 2>> triangles_;  // the other corners, seen from the lowest one
  std::vector<Edge> edges_;                     // seen from the lower end
  std::vector<std::uint32_t> local_;            // by vertex of the box
};

}  // namespace reeb
