// How many simplices of each dimension a mesh lists.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace reeb {

// A simplex of a mesh has at most nine corners.
constexpr std::size_t kMaxSimplexDimension = 8;

// counts[k] is the number of simplices of dimension k as the mesh lists them: triangles after polygons became fans,
// degenerate ones included, and cells after their division. [0] counts the points that are listed, not the vertices.
using SimplexCounts = std::array<std::uint64_t, kMaxSimplexDimension + 1>;

}  // namespace reeb
