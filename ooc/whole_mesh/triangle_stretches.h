// The triangles of a mesh a stretch at a time, with the distinct vertices of each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "ooc/tables/local_numbers.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

// What is kept by vertex lies in pages, some of them on disk. Triangles whose order runs across that of
// the vertices touch a page anew at nearly every corner; a stretch of many triangles, whose vertices are
// looked up once and in ascending order, touches each page once. So stretches are as long as a share
// of the memory allows.
//
// TIME: a hash look-up a corner, and a sort of the distinct vertices where they lie far apart.
// MEMORY: one share, reserved; half a kilobyte a triangle, 2 MiB at least and 72 MiB at most.
class TriangleStretches {
 public:
  // Reads from the first triangle on.
  TriangleStretches(const char* owner, IndexedMesh& mesh, Workspace& space);

  // False at the end of the mesh.
  bool next();

  // The place of the first triangle of this stretch among all.
  std::uint64_t first_triangle() const { return first_triangle_; }
  std::span<const VertexId> corners() const { return corners_; }
  // The number of each corner's vertex in this stretch, by first appearance.
  std::span<const std::uint32_t> numbers() const { return numbers_; }
  // The vertex of each number.
  std::span<const VertexId> vertices() const { return vertices_; }
  // All numbers, in an order in which their vertices are best looked up.
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
