// The triangles of a mesh in groups of consecutive ones, with the distinct vertices of each group.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "ooc/tables/local_numbers.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

// Data per vertex is in pages, some of them on disk. If the order of triangles runs across that of the vertices, nearly
// every corner touches another page. A group of many triangles, whose vertices are looked up once and in ascending
// order, touches each page once. So groups are as long as a share of the memory allows. They are called stretches here.
//
// TIME: a hash look-up per corner, and a sort of the distinct vertices if they are far apart.
// MEMORY: one share, reserved; half a kilobyte per triangle, at least 2 MiB and at most 64 MiB.
class TriangleStretches {
 public:
  // Reads the mesh, starting at the first triangle.
  TriangleStretches(const char* owner, IndexedMesh& mesh, Workspace& space);

  // False at the end of the mesh.
  bool next();

  // The index of the first triangle of this stretch.
  std::uint64_t first_triangle() const { return first_triangle_; }
  std::span<const VertexId> corners() const { return corners_; }
  // The number of each corner's vertex within this stretch, by first appearance.
  std::span<const std::uint32_t> numbers() const { return numbers_; }
  // The vertex of each number.
  std::span<const VertexId> vertices() const { return vertices_; }
  // All numbers, in an order that is good for looking up their vertices.
  std::span<const std::uint32_t> lookup_order() const { return lookup_order_; }

 private:
  void order_lookups();

  IndexedMesh& mesh_;
  std::size_t stretch_;
  Reservation charge_;
  std::uint64_t first_triangle_ = 0;
  std::vector<VertexId> corners_, vertices_;
  std::vector<std::uint32_t> numbers_, lookup_order_;
  LocalNumbers local_numbers_;
};

}  // namespace reeb::ooc
