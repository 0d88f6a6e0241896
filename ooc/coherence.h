// How large a front a mesh may have before its order counts as incoherent.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace reeb::ooc {

// A front of many times the square root of the mesh is what an incoherent order gives, not a shape; its
// long paths cost more than sorting the triangles.
inline std::uint64_t usual_front(std::uint64_t vertices) {
  constexpr double kMuch = 16, kLittle = 4096;
  return static_cast<std::uint64_t>(std::max(kLittle, kMuch * std::sqrt(static_cast<double>(vertices))));
}

// Nor is a front incoherent of which stretches of so many triangles have three times as many vertices.
inline std::uint64_t front_for(std::uint64_t stretch_triangles) { return stretch_triangles / 6; }

}  // namespace reeb::ooc
