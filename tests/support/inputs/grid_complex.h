// Grids as complexes, written from the definition: each cube has a tetrahedron for each order of the axes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/inputs/complex.h"
#include "tests/support/random.h"

namespace reeb::test {

using GridShape = std::array<std::uint64_t, 3>;

inline std::uint64_t vertices_of(const GridShape& shape) { return shape[0] * shape[1] * shape[2]; }

// The simplices of the division whose vertices all are in `present` and that are no face of a larger such simplex,
// corners ascending. Vertices without a simplex are not listed.
inline std::set<std::vector<std::uint64_t>> simplices_of_grid(const GridShape& shape,
                                                              const std::vector<bool>& present) {
  const auto index = [&](const GridShape& at) { return at[0] + shape[0] * (at[1] + shape[1] * at[2]); };
  std::vector<std::size_t> axes;
  for (std::size_t k = 0; k < 3; ++k)
    if (shape[k] > 1) axes.push_back(k);
  // All faces of all cells, then only those that are in no other.
  std::set<std::vector<std::uint64_t>> all;
  for (GridShape base{}; base[2] < shape[2]; ++base[2])
    for (base[1] = 0; base[1] < shape[1]; ++base[1])
      for (base[0] = 0; base[0] < shape[0]; ++base[0]) {
        if (std::any_of(axes.begin(), axes.end(), [&](std::size_t k) { return base[k] + 1 == shape[k]; })) continue;
        std::vector<std::size_t> order = axes;
        do {
          GridShape at = base;
          std::vector<std::uint64_t> cell{index(at)};
          for (const std::size_t k : order) {
            ++at[k];
            cell.push_back(index(at));
          }
          for (unsigned set = 1; set < 1u << cell.size(); ++set) {
            std::vector<std::uint64_t> face;
            for (std::size_t c = 0; c < cell.size(); ++c)
              if ((set >> c & 1) != 0) face.push_back(cell[c]);
            if (face.size() > 1 && std::all_of(face.begin(), face.end(), [&](std::uint64_t v) { return present[v]; }))
              all.insert(face);
          }
        } while (std::next_permutation(order.begin(), order.end()));
      }
  std::set<std::vector<std::uint64_t>> faces;
  for (const auto& simplex : all)
    for (std::size_t without = 0; without < simplex.size(); ++without) {
      auto face = simplex;
      face.erase(face.begin() + static_cast<std::ptrdiff_t>(without));
      faces.insert(face);
    }
  for (const auto& face : faces) all.erase(face);
  return all;
}

inline std::array<double, 3> position_in(const GridShape& shape, std::uint64_t v) {
  return {static_cast<double>(v % shape[0]), static_cast<double>(v / shape[0] % shape[1]),
          static_cast<double>(v / shape[0] / shape[1])};
}

// The whole grid with these values.
inline Complex complex_of_grid(const GridShape& shape, std::vector<double> values) {
  Complex complex;
  const auto simplices = simplices_of_grid(shape, std::vector<bool>(values.size(), true));
  complex.simplices.assign(simplices.begin(), simplices.end());
  for (std::uint64_t v = 0; v < values.size(); ++v) complex.positions.push_back(position_in(shape, v));
  complex.values = std::move(values);
  return complex;
}

// From a single vertex to a few in three dimensions.
inline GridShape random_grid(Random& random) {
  GridShape shape{1, 1, 1};
  const std::uint64_t most = random.chance(50) ? 3 : 6;
  for (std::uint64_t& size : shape)
    if (!random.chance(25)) size = random.between(1, most);
  return shape;
}

// Smooth, rough or with many ties.
inline std::vector<double> random_grid_values(const GridShape& shape, Random& random) {
  std::vector<double> values(vertices_of(shape));
  const std::uint64_t kind = random.below(4), levels = random.between(2, 6);
  for (std::size_t v = 0; v < values.size(); ++v) {
    const auto at = position_in(shape, v);
    const double slope = at[0] + 0.7 * at[1] - 0.4 * at[2];
    values[v] = kind == 0   ? random.unit()
                : kind == 1 ? static_cast<double>(random.below(levels))
                : kind == 2 ? slope + 0.5 * random.unit()
                            : slope;
  }
  return values;
}

}  // namespace reeb::test
