// The parts of a mesh that are in some balls, collected in one reading, and patches cut out of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/defects/surface_patch.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/patches/ball_grid.h"
#include "ooc/patches/vertex_set.h"

namespace reeb::ooc {

// Use: add() every batch of the mesh, finish(), then cut patches.
//
// MEMORY:  about 130 bytes and 8 per function for each vertex in the balls, and a bit per vertex of the mesh, from the
//          budget.
// THREADS: any number may call const members at the same time.
class CollectedSurface {
 public:
  // `functions`: values that come with each vertex.
  CollectedSurface(std::span<const Ball> balls, std::size_t functions, MemoryBudget& budget);

  // `values[k]` are those of function k at the vertices of the batch.
  // THROWS: Error{kResource} if the memory does not suffice.
  void add(const MeshBatch& batch, std::span<const std::vector<double>> values);
  void finish();

  std::uint32_t vertex_count() const { return set_.size(); }
  // Of the edges of all triangles; 0 if there are none.
  double mean_edge() const;

  struct Patch {
    SurfacePatch surface;
    std::vector<std::vector<double>> values;  // by function
    bool limited = false;                     // it has as many vertices as it may
  };

  // What is connected with the seeds in the balls, up to a number of vertices. Seeds that were not collected are
  // ignored.
  Patch cut(std::span<const VertexId> seeds, std::span<const Ball> balls, std::size_t most_vertices) const;

 private:
  void add_triangle(VertexId a, VertexId b, VertexId c);

  BallGrid grid_;
  VertexSet set_;
  std::vector<VertexId> vertices_;
  std::vector<Point> positions_;
  std::vector<std::vector<double>> values_;
  std::vector<std::uint8_t> whole_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> first_, at_;  // triangles at each vertex
  Reservation memory_;
};

}  // namespace reeb::ooc
