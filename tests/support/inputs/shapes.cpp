#include "tests/support/inputs/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/support/inputs/partition.h"

namespace reeb::test {
namespace {

// Renumbers the vertices so that the members of a set become one, in order of appearance.
Complex quotient(const Complex& complex, Partition& sets) {
  Complex result;
  std::map<std::size_t, std::uint64_t> number;
  for (std::size_t v = 0; v < complex.vertex_count(); ++v) {
    if (!number.try_emplace(sets.find(v), result.vertex_count()).second) continue;
    result.positions.push_back(complex.positions[v]);
    result.values.push_back(complex.values[v]);
  }
  result.simplices = complex.simplices;
  for (auto& simplex : result.simplices)
    for (std::uint64_t& corner : simplex) corner = number.at(sets.find(corner));
  result.kind = complex.kind;
  return result;
}

void glue_left_to_right(Partition& sets, std::size_t columns, std::size_t rows, bool twisted) {
  for (std::size_t j = 0; j <= rows; ++j)
    sets.unite(j * (columns + 1) + columns, (twisted ? rows - j : j) * (columns + 1));
}

void glue_bottom_to_top(Partition& sets, std::size_t columns, std::size_t rows, bool twisted) {
  for (std::size_t i = 0; i <= columns; ++i) sets.unite(rows * (columns + 1) + i, twisted ? columns - i : i);
}

void glue_to_a_point(Partition& sets, std::size_t columns, std::size_t row) {
  for (std::size_t i = 1; i <= columns; ++i) sets.unite(row * (columns + 1), row * (columns + 1) + i);
}

Complex disc(std::size_t columns, std::size_t rows) {
  Complex complex;
  for (std::size_t j = 0; j <= rows; ++j)
    for (std::size_t i = 0; i <= columns; ++i)
      complex.positions.push_back({static_cast<double>(i), static_cast<double>(j), 0.0});
  complex.values.assign(complex.positions.size(), 0.0);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const std::uint64_t corner = j * (columns + 1) + i, above = corner + columns + 1;
      complex.simplices.push_back({corner, corner + 1, above});
      complex.simplices.push_back({corner + 1, above + 1, above});
    }
  complex.kind = "grid " + std::to_string(columns) + "x" + std::to_string(rows);
  return complex;
}

// Removes a triangle from each, and glues the two holes.
Complex connected_sum(Complex first, Complex second) {
  const std::vector<std::uint64_t> hole = first.simplices.back();
  std::vector<std::uint64_t> other = second.simplices.front();
  first.simplices.pop_back();
  second.simplices.erase(second.simplices.begin());
  std::reverse(other.begin(), other.end());  // opposite orientations meet
  const std::size_t offset = first.vertex_count();
  const Complex both = disjoint_union(first, second);
  Partition sets(both.vertex_count());
  for (std::size_t i = 0; i < 3; ++i) sets.unite(hole[i], other[i] + offset);
  return quotient(both, sets);
}

}  // namespace

Complex glued_grid(std::size_t columns, std::size_t rows, Gluing gluing) {
  const Complex complex = disc(columns, rows);
  Partition sets(complex.vertex_count());
  switch (gluing) {
    case Gluing::kDisc:
      break;
    case Gluing::kCylinder:
      glue_left_to_right(sets, columns, rows, false);
      break;
    case Gluing::kMoebius:
      glue_left_to_right(sets, columns, rows, true);
      break;
    case Gluing::kTorus:
      glue_left_to_right(sets, columns, rows, false);
      glue_bottom_to_top(sets, columns, rows, false);
      break;
    case Gluing::kKlein:
      glue_left_to_right(sets, columns, rows, true);
      glue_bottom_to_top(sets, columns, rows, false);
      break;
    case Gluing::kProjective:
      glue_left_to_right(sets, columns, rows, true);
      glue_bottom_to_top(sets, columns, rows, true);
      break;
    case Gluing::kSphere:
      glue_left_to_right(sets, columns, rows, false);
      glue_to_a_point(sets, columns, 0);
      glue_to_a_point(sets, columns, rows);
      break;
  }
  Complex result = quotient(complex, sets);
  result.kind += " glued as " + std::to_string(static_cast<int>(gluing));
  return result;
}

Complex upright_torus(std::size_t rings, std::size_t sides) {
  Complex torus = glued_grid(sides, rings, Gluing::kTorus);
  for (std::size_t v = 0; v < torus.vertex_count(); ++v) {
    const double turn = 2 * std::numbers::pi;
    const double tube = turn * torus.positions[v][0] / static_cast<double>(sides);
    const double ring = turn * torus.positions[v][1] / static_cast<double>(rings);
    const double radius = 3 + std::cos(tube);
    torus.positions[v] = {radius * std::cos(ring), std::sin(tube), radius * std::sin(ring)};
    const auto& [x, y, z] = torus.positions[v];
    torus.values[v] = z + 0.013 * x + 0.0071 * y;
  }
  torus.kind = "upright torus " + std::to_string(rings) + "x" + std::to_string(sides);
  return torus;
}

Complex closed_surface(unsigned genus, std::size_t columns, std::size_t rows) {
  if (genus == 0) return glued_grid(columns, rows, Gluing::kSphere);
  const Complex torus = glued_grid(columns, rows, Gluing::kTorus);
  Complex surface = torus;
  for (unsigned i = 1; i < genus; ++i) surface = connected_sum(surface, torus);
  surface.kind = "surface of genus " + std::to_string(genus);
  return surface;
}

Complex fan(std::size_t blades, bool closed) {
  Complex complex;
  const std::size_t rim = closed ? blades : blades + 1;
  complex.positions.push_back({0, 0, 0});
  for (std::size_t i = 0; i < rim; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(rim);
    complex.positions.push_back({std::cos(angle), std::sin(angle), 0});
  }
  complex.values.assign(complex.positions.size(), 0.0);
  for (std::size_t i = 0; i < blades; ++i) complex.simplices.push_back({0, 1 + i, 1 + (i + 1) % rim});
  complex.kind = "fan of " + std::to_string(blades);
  return complex;
}

Complex book(std::size_t pages) {
  Complex complex;
  complex.positions = {{0, 0, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < pages; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(pages);
    complex.simplices.push_back({0, 1, complex.positions.size()});
    complex.positions.push_back({std::cos(angle), std::sin(angle), 0.5});
  }
  complex.values.assign(complex.positions.size(), 0.0);
  complex.kind = "book of " + std::to_string(pages);
  return complex;
}

Complex plateau(std::size_t columns, std::size_t rows) {
  Complex complex = disc(columns, rows);
  complex.kind = "plateau " + complex.kind;
  return complex;
}

Complex tied_strip(std::size_t columns, std::size_t rows) {
  Complex complex = disc(columns, rows);
  for (std::size_t v = 0; v < complex.vertex_count(); ++v) complex.values[v] = complex.positions[v][1];
  complex.kind = "tied strip " + complex.kind;
  return complex;
}

Complex disjoint_union(const Complex& first, const Complex& second) {
  Complex both = first;
  const std::uint64_t offset = first.vertex_count();
  both.positions.insert(both.positions.end(), second.positions.begin(), second.positions.end());
  both.values.insert(both.values.end(), second.values.begin(), second.values.end());
  for (auto simplex : second.simplices) {
    for (std::uint64_t& corner : simplex) corner += offset;
    both.simplices.push_back(std::move(simplex));
  }
  both.kind += " and " + second.kind;
  return both;
}

}  // namespace reeb::test
