// The largest front of a mesh whose order counts as coherent.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace reeb::ooc {

// A front of many times the square root of the mesh comes from an incoherent order, not from a shape. Its long paths
// cost more than sorting the triangles.
inline std::uint64_t usual_front(std::uint64_t vertices) {
  constexpr double kPerSquareRoot = 16, kSmallFront = 4096;
  return static_cast<std::uint64_t>(std::max(kSmallFront, kPerSquareRoot * std::sqrt(static_cast<double>(vertices))));
}

// The same where chunks are cut from stretches of this many triangles. The front may have a third of the vertices of
// such a stretch, unless that is a large part of the mesh.
inline std::uint64_t usual_front(std::uint64_t vertices, std::uint64_t stretch_triangles) {
  constexpr std::uint64_t kMeshShare = 64;
  return std::max(usual_front(vertices), std::min(stretch_triangles / 6, vertices / kMeshShare));
}

// The same for a stream of which nothing is known but about how many vertices it has: a volume can come in layers.
inline std::uint64_t usual_front_of_volume(std::uint64_t vertices) {
  constexpr double kLayers = 2, kSmallFront = 4096;
  return static_cast<std::uint64_t>(std::max(kSmallFront, kLayers * std::pow(static_cast<double>(vertices), 2. / 3)));
}

}  // namespace reeb::ooc
