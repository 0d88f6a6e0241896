// The parts of a mesh in some balls, collected in one reading with the places of their triangles, to be edited.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/repair/editable_patch.h"
#include "ooc/patches/ball_grid.h"
#include "ooc/patches/vertex_set.h"

namespace reeb::ooc {

// Use: add() every batch of the mesh, finish(), then take patches. A patch is everything in its balls, connected or
// not.
//
// MEMORY:  about 110 bytes for each vertex in the balls, and a bit per vertex of the mesh, from the budget.
// THREADS: any number may call const members at the same time.
class CollectedPatches {
 public:
  // `patch_of[i]` is the patch of ball i, below `patches`. REQUIRES: balls of different patches do not meet.
  CollectedPatches(std::span<const Ball> balls, std::span<const std::uint32_t> patch_of, std::size_t patches,
                   MemoryBudget& budget);

  // THROWS: Error{kResource} if the memory does not suffice.
  void add(const MeshBatch& batch);
  void finish();

  std::uint64_t mesh_vertices() const { return mesh_vertices_; }
  std::uint64_t mesh_triangles() const { return mesh_triangles_; }

  // Its vertices ascend.
  EditablePatch patch(std::size_t number) const;

 private:
  struct Triangle {
    std::array<std::uint32_t, 3> corners;
    std::uint64_t id;
  };

  void add_triangle(VertexId a, VertexId b, VertexId c);
  void use(VertexId v);

  BallGrid grid_;
  std::vector<std::uint32_t> patch_of_;
  VertexSet set_;
  std::vector<VertexId> vertices_;
  std::vector<Point> positions_;
  std::vector<std::uint32_t> patch_;  // of each vertex
  std::vector<std::uint8_t> whole_, used_elsewhere_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> vertex_first_, vertex_order_, triangle_first_, triangle_order_;  // by patch
  std::uint64_t mesh_vertices_ = 0, mesh_triangles_ = 0;
  Reservation memory_;
};

}  // namespace reeb::ooc
