// What is wrong with a surface, straight from the definitions (docs/SEMANTICS.md, Census of a surface), slow and plain:
// the model by which the census is judged. It shares no code with the census.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "tests/support/inputs/complex.h"

namespace reeb::test {

// Vertices, ascending.
using VertexSet = std::vector<std::uint64_t>;

struct ReferenceComponent {
  std::uint64_t triangles = 0, vertices = 0, lowest = 0;
};
struct ReferenceBoundary {
  std::uint64_t edges = 0, lowest = 0;
  double length = 0;
  std::array<double, 3> min{}, max{};
};

struct ReferenceCensus {
  std::vector<ReferenceComponent> components;
  std::vector<ReferenceBoundary> boundaries;
  std::set<VertexSet> nonmanifold_edges, nonmanifold_vertices, folded, loose_edges;
  std::map<VertexSet, std::uint64_t> degenerate, duplicates;  // and how often
  std::int64_t euler = 0;
  bool closed = false;
  std::optional<bool> orientable, oriented;
  std::optional<std::uint64_t> genus;
};

// Of a complex of points, edges and triangles.
ReferenceCensus reference_census(const Complex& complex);

}  // namespace reeb::test
