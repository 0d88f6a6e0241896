// Closed surfaces with planted tunnels and bridges of known place, size and kind, beside large genuine handles.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace reeb::test {

using Vector = std::array<double, 3>;

// The axis of a round hole through a wall (a tunnel), or of a round bar between two walls (a bridge).
struct Planted {
  bool tunnel = false;
  Vector from{}, to{};
  double radius = 0;
  double length() const { return 2 * 3.14159265358979 * radius; }
};

struct PlantedMesh {
  std::vector<Vector> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double edge = 0.5;  // of a triangle, roughly; a cell has some ten triangles of the surface
  std::vector<Planted> planted;
  std::size_t genuine = 0;  // loops that are no defects
};

struct PlantedOptions {
  std::uint64_t seed = 1;
  double least_radius = 0.5, most_radius = 4;  // in cells
  std::size_t most_planted = 4;
  double noise = 0;  // of the vertices, in cells
  bool inwards = false;
};

// Two plates, one above the other, joined by four pillars near their corners; holes in the plates, bars between them,
// all turned at random, and sampled on a grid. Every one of them is there: the genus is `planted` and `genuine`
// together.
PlantedMesh planted_mesh(const PlantedOptions& options);

std::size_t component_count(const PlantedMesh& mesh);
// Of a closed surface of one component.
std::size_t genus(const PlantedMesh& mesh);

// A text with nine digits, and a binary PLY file.
std::string to_off(const PlantedMesh& mesh);
std::string to_ply(const PlantedMesh& mesh);

}  // namespace reeb::test
