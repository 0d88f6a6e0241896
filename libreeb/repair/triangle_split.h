// Puts vertices on edges of a patch, and divides the triangles at these edges.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "libreeb/repair/editable_patch.h"

namespace reeb {

// What was done to a patch, so that it can be undone.
struct PatchSplit {
  std::size_t vertices = 0, triangles = 0;  // of the patch, before
  std::vector<std::uint32_t> removed;       // those that were divided
};
void undo_split(EditablePatch& patch, const PatchSplit& split);

// Use: add points and ways, then run().
class TriangleSplit {
 public:
  // `float32`: positions of new vertices are float32 numbers.
  TriangleSplit(EditablePatch& patch, bool float32);

  // Adds a vertex on an edge, `twelfths` of the way from a to b: 1 to 11. The same place is the same vertex.
  // REQUIRES: all triangles at the edge are in the patch.
  std::uint32_t point_on(std::uint32_t a, std::uint32_t b, int twelfths);
  // Two vertices on different edges of a triangle, or a corner and one on the opposite edge, will be joined. Ways in
  // one triangle must not cross.
  void join(std::uint32_t triangle, std::uint32_t a, std::uint32_t b) { ways_[triangle].emplace_back(a, b); }

  // Divides every triangle with a point on its edges. No part is without area if the triangle is not.
  PatchSplit run();

 private:
  struct Place {
    std::uint32_t vertex;
    std::array<int, 2> at;  // in twelfths of two sides of the triangle
  };
  void divide(std::uint32_t triangle);
  void cut_ears(std::vector<Place> polygon);

  EditablePatch& patch_;
  const bool float32_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::map<int, std::uint32_t>> points_;  // by the edge
  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> ways_;      // by the triangle
  PatchSplit split_;
};

// Divides the triangles at a closed curve along edges so that there is room for a band on either side of it: all others
// of its edges get a vertex in their middle, or two if both ends are on the curve.
// REQUIRES: the vertices of the curve are whole.
PatchSplit make_room(EditablePatch& patch, const std::vector<std::uint32_t>& curve, bool float32);

}  // namespace reeb
