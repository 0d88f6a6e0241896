// A surface read and recounted in the plainest way, independent of the program.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace reeb::test {

struct PlainSurface {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::string header;  // of a PLY file
};

// From the bytes of a binary PLY file of float or double coordinates, which come first, and triangles.
PlainSurface read_plain_ply(const std::string& bytes);
// From the text of an OFF file.
PlainSurface read_plain_off(const std::string& text);

struct SurfaceCount {
  std::int64_t euler = 0;  // of what triangles name
  std::size_t components = 0, boundary_edges = 0, nonmanifold_edges = 0, coincident = 0, unused_vertices = 0;
  std::size_t nonmanifold_vertices = 0, unoriented_edges = 0;
  bool is_closed_manifold() const {
    return boundary_edges + nonmanifold_edges + coincident + nonmanifold_vertices == 0;
  }
  std::int64_t genus() const { return static_cast<std::int64_t>(components) - euler / 2; }
};
SurfaceCount recount(const PlainSurface& surface);

}  // namespace reeb::test
