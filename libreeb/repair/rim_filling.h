// Closes a rim: the closed boundary of a hole in a surface is filled with triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "libreeb/graph/settled_node.h"

namespace reeb {

// What is known of a rim. Entry i of the lists is of its vertex i, or of its edge from i to the next one.
struct Rim {
  std::vector<Point> points;
  std::vector<Point> beside;                                    // the third corner of the triangle at each edge
  std::vector<double> edge;                                     // how long edges of the surface are at each vertex
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined;  // vertices a < b that have an edge already; sorted
};

enum class FillWeight {
  kArea,   // the least sum of areas
  kAngle,  // the least of the greatest angles between neighbours; then of areas
};

struct FillOptions {
  FillWeight weight = FillWeight::kArea;
  bool refine = false;   // to the length of the edges around, and fair
  bool float32 = false;  // positions of new vertices are float32 numbers
};

struct Filling {
  struct Vertex {
    Point position{};
    std::array<std::uint32_t, 3> parents{};  // numbers below its own: it began as their mean
  };
  std::vector<Vertex> vertices;                         // numbered from the size of the rim on
  std::vector<std::array<std::uint32_t, 3>> triangles;  // along the rim from i to i + 1
};

constexpr std::size_t kMostRimVertices = 1500;

// The best triangulation of the rim by its vertices (Barequet and Sharir 1995; Liepa 2003), of those that repeat no
// edge of the surface; nothing if there is none. Then more vertices, if wanted (Liepa 2003).
// TIME: O(n^3) for n vertices. MEMORY: 20 n^2 bytes. REQUIRES: 3 <= n <= kMostRimVertices.
std::optional<Filling> fill_rim(const Rim& rim, const FillOptions& options);

}  // namespace reeb
