#include "tests/support/inputs/complex.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <sstream>

#include "tests/support/inputs/partition.h"
#include "tests/support/random.h"

namespace reeb::test {

Complex make_complex(std::vector<double> values, std::vector<std::vector<std::uint64_t>> simplices) {
  Complex complex;
  complex.positions.assign(values.size(), {});
  complex.values = std::move(values);
  complex.simplices = std::move(simplices);
  complex.kind = "by hand";
  return complex;
}

Skeleton two_skeleton(const Complex& complex) {
  std::set<std::array<std::uint64_t, 2>> edges;
  std::set<std::array<std::uint64_t, 3>> triangles;
  for (const auto& simplex : complex.simplices) {
    const std::set<std::uint64_t> distinct(simplex.begin(), simplex.end());
    for (const std::uint64_t a : distinct)
      for (const std::uint64_t b : distinct) {
        if (a >= b) continue;
        edges.insert({a, b});
        for (const std::uint64_t c : distinct)
          if (b < c) triangles.insert({a, b, c});
      }
  }
  return {{edges.begin(), edges.end()}, {triangles.begin(), triangles.end()}};
}

std::vector<std::uint64_t> sweep_order(const Complex& complex) {
  std::vector<std::uint64_t> order(complex.vertex_count());
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint64_t a, std::uint64_t b) { return complex.values[a] < complex.values[b]; });
  return order;
}

Complex shuffled(Complex complex, std::uint64_t seed) {
  Random random(seed);
  random.shuffle(complex.simplices);
  for (auto& simplex : complex.simplices) random.shuffle(simplex);
  complex.kind += ", shuffled by " + std::to_string(seed);
  return complex;
}

std::uint64_t component_count(const Complex& complex) {
  Partition sets(complex.vertex_count());
  for (const auto& simplex : complex.simplices)
    for (const std::uint64_t corner : simplex) sets.unite(corner, simplex.front());
  std::uint64_t count = 0;
  for (std::size_t v = 0; v < complex.vertex_count(); ++v)
    if (sets.find(v) == v) ++count;
  return count;
}

std::string describe(const Complex& complex) {
  std::ostringstream out;
  out.precision(17);
  out << complex.kind << "\nvalues:";
  for (const double value : complex.values) out << ' ' << value;
  out << "\nsimplices:";
  for (const auto& simplex : complex.simplices) {
    out << " (";
    for (std::size_t i = 0; i < simplex.size(); ++i) out << (i > 0 ? " " : "") << simplex[i];
    out << ')';
  }
  return out.str();
}

Complex beginning(const Complex& complex, std::size_t vertices, std::size_t simplices) {
  Complex part = complex;
  part.values.resize(vertices);
  part.positions.resize(vertices);
  part.simplices.resize(simplices);
  return part;
}

}  // namespace reeb::test
