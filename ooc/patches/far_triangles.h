// Large triangles that reach into balls although a corner of theirs is outside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/indexed_mesh.h"
#include "ooc/patches/ball_grid.h"

namespace reeb::ooc {

// Balls of one patch are what is known of a mesh there; balls of different patches do not meet.
struct PatchBall {
  Ball ball;
  std::uint32_t patch = 0;
  double least = 0;  // smaller triangles, by the longest side of their boxes, are left out
};

struct FarTriangle {
  std::array<VertexId, 3> corners;
  std::array<Point, 3> points;
};

struct FarTriangles {
  std::vector<std::vector<FarTriangle>> of_patch;
  Reservation memory;
};

// Of each patch, the triangles that are large enough, meet a ball, and do not have all their corners in balls of that
// patch; perhaps a few more that only come near. Reads all triangles once, in their order.
// MEMORY: about 250 bytes for each ball, 100 for each triangle that is found, from the budget.
// THROWS: Error{kResource} if the memory does not suffice; what the mesh throws, and progress().
FarTriangles find_far_triangles(IndexedMesh& mesh, std::span<const PatchBall> balls, std::size_t patches,
                                MemoryBudget& budget, const std::function<void(const IndexedMesh&)>& progress);

}  // namespace reeb::ooc
