// How large a front a mesh may have before its order counts as incoherent.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace reeb::ooc {

// A front of many times the square root of the mesh is what an incoherent order gives, not a shape; its
// long paths cost more than sorting the triangles.
inline std::uint64_t usual_front(std::uint64_t vertices) {
  constexpr double kSquareRoots = 16, kSmallFront = 4096;
  return static_cast<std::uint64_t>(std::max(kSmallFront, kSquareRoots * std::sqrt(static_cast<double>(vertices))));
}

// The same where chunks are cut from stretches of so many triangles, which have three times as many
// vertices as a wide front; so it is no large part of the mesh.
inline std::uint64_t usual_front(std::uint64_t vertices, std::uint64_t stretch_triangles) {
  constexpr std::uint64_t kLargePart = 64;
  return std::max(usual_front(vertices), std::min(stretch_triangles / 6, vertices / kLargePart));
}

}  // namespace reeb::ooc
