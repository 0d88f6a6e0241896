// A whole mesh in memory, for functions that need all of it before the first value is known.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_numbering.h"

namespace reeb::io {

// Only lengths of edges and what is adjacent matter here, so positions may have any dimension.
struct WholeComplex {
  unsigned dimension = 3;
  int unit_exponent = 0;                                // coordinates are in units of 2 to this power
  std::vector<double> coordinates;                      // `dimension` of each vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;  // three different corners each
  std::vector<std::array<std::uint32_t, 2>> edges;      // of all other simplices, each perhaps more than once
  bool is_surface = true;                               // no simplex but triangles
  bool has_cells = false;                               // a simplex of more than three corners
  VertexNumbering numbers;                              // in the mesh
  std::uint64_t number_count = 0;                       // of vertices in the mesh, also of those that it leaves out
  Reservation memory;

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(coordinates.size() / dimension); }
  double length(std::uint32_t a, std::uint32_t b) const;
};

// Chooses a unit about as long as the longest edge, so that products of lengths neither overflow nor vanish.
// Coordinates change by a power of two, and lose nothing.
void use_unit_of_edges(WholeComplex& complex);

// Reads all of the mesh, and chooses that unit. MEMORY: 8 bytes a coordinate, 12 a triangle, 8 an edge; reserved before
// it is held. THROWS: Error{kBadInput} of the reader; Error{kResource} if the budget does not allow it, or as
// require_numbers().
WholeComplex read_whole(MeshReader& reader, MemoryBudget& budget);

// THROWS: Error{kResource} if there are 2^32 - 1 or more of these items.
void require_numbers(std::uint64_t count, const char* items);

// For each vertex, items that have it: of vertex v those at items[begin[v]] up to items[begin[v + 1]].
struct Incidence {
  std::vector<std::uint64_t> begin;
  std::vector<std::uint32_t> items;

  std::span<const std::uint32_t> of(std::uint32_t v) const {
    return {items.data() + begin[v], static_cast<std::size_t>(begin[v + 1] - begin[v])};
  }
};

// MEMORY: 8 bytes a vertex, 4 a corner; the caller reserves it.
template <std::size_t N>
Incidence incidence_of(std::uint32_t vertices, const std::vector<std::array<std::uint32_t, N>>& items) {
  Incidence result;
  result.begin.assign(std::size_t{vertices} + 1, 0);
  for (const auto& item : items)
    for (const std::uint32_t v : item) ++result.begin[v];
  std::uint64_t sum = 0;
  for (std::uint64_t& place : result.begin) sum = (place += sum);
  result.items.resize(sum);
  for (std::size_t i = items.size(); i-- > 0;)
    for (const std::uint32_t v : items[i]) result.items[--result.begin[v]] = static_cast<std::uint32_t>(i);
  return result;
}

// The number of the connected component of each vertex, and how many there are. MEMORY: 4 bytes a vertex.
struct Components {
  std::vector<std::uint32_t> of_vertex;
  std::uint32_t count = 0;
};
Components components_of(const WholeComplex& complex);

}  // namespace reeb::io
