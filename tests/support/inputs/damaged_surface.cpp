#include "tests/support/inputs/damaged_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "tests/support/random.h"

namespace reeb::test {
namespace {

class Damage {
 public:
  Damage(std::uint64_t seed, bool triangles_only) : random_(seed), triangles_only_(triangles_only) {}

  Complex make() {
    for (std::uint64_t parts = random_.between(1, 3); parts != 0; --parts) add_part();
    for (std::uint64_t times = random_.chance(20) ? 0 : random_.between(1, 6); times != 0; --times) damage();
    if (random_.chance(30)) add_vertices(random_.between(1, 3));
    complex_.values.assign(complex_.vertex_count(), 0);
    if (random_.chance(70)) renumber();
    if (random_.chance(70)) random_.shuffle(complex_.simplices);
    complex_.kind = "damaged surface";
    return std::move(complex_);
  }

 private:
  using Simplex = std::vector<std::uint64_t>;

  void add_vertices(std::uint64_t count) {
    for (; count != 0; --count) complex_.positions.push_back({random_.unit(), random_.unit(), random_.unit()});
  }

  // A grid that is closed along none, one or both axes, perhaps with a twist; or a soup of triangles.
  void add_part() {
    const std::uint64_t first = complex_.vertex_count();
    if (random_.chance(10)) {
      const std::uint64_t count = random_.between(3, 9);
      add_vertices(count);
      for (std::uint64_t i = random_.between(1, 15); i != 0; --i)
        complex_.simplices.push_back(
            {first + random_.below(count), first + random_.below(count), first + random_.below(count)});
      return;
    }
    const std::uint64_t columns = random_.between(3, 9), rows = random_.between(3, 9);
    const bool around = random_.chance(50), closed = random_.chance(50), twisted = random_.chance(30);
    const double noise = random_.chance(20) ? 2 : 0.2;
    for (std::uint64_t j = 0; j < rows; ++j)
      for (std::uint64_t i = 0; i < columns; ++i) {
        const double u = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(columns);
        const auto z = static_cast<double>(j);
        complex_.positions.push_back({3 * std::cos(u) + noise * random_.unit(),
                                      3 * std::sin(u) + noise * random_.unit(), z + noise * random_.unit()});
      }
    const auto vertex = [&](std::uint64_t i, std::uint64_t j) {
      if (j == rows) {
        j = 0;
        if (twisted) i = (columns - i) % columns;
      }
      return first + (i % columns) + columns * j;
    };
    for (std::uint64_t j = 0; j + (closed ? 0 : 1) < rows; ++j)
      for (std::uint64_t i = 0; i + (around ? 0 : 1) < columns; ++i) {
        complex_.simplices.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        complex_.simplices.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }

  void damage() {
    if (complex_.simplices.empty()) return;
    const std::size_t at = static_cast<std::size_t>(random_.below(complex_.simplices.size()));
    Simplex simplex = complex_.simplices[at];
    switch (random_.below(9)) {
      case 0:  // holes
        for (std::uint64_t i = random_.between(1, 4); i != 0 && complex_.simplices.size() > 1; --i)
          complex_.simplices.erase(complex_.simplices.begin() +
                                   static_cast<std::ptrdiff_t>(random_.below(complex_.simplices.size())));
        break;
      case 1:  // copies, turned or not
        for (std::uint64_t i = random_.between(1, 3); i != 0; --i) {
          random_.shuffle(simplex);
          complex_.simplices.push_back(simplex);
        }
        break;
      case 2:  // degenerate
        if (simplex.size() == 3) simplex[random_.below(3)] = simplex[random_.below(3)];
        complex_.simplices[at] = simplex;
        if (random_.chance(30)) complex_.simplices.push_back(simplex);
        break;
      case 3:  // turned
        std::swap(complex_.simplices[at].front(), complex_.simplices[at].back());
        break;
      case 4:  // two vertices become one
        weld(random_.below(complex_.vertex_count()), random_.below(complex_.vertex_count()));
        break;
      case 5:  // a fin
        add_vertices(1);
        complex_.simplices.push_back({simplex[0], simplex.back(), complex_.vertex_count() - 1});
        break;
      case 6:  // a fold, or a triangle without area
        complex_.positions[simplex[0]] = complex_.positions[random_.below(complex_.vertex_count())];
        break;
      case 7:  // a triangle between any vertices
        for (std::uint64_t& corner : simplex) corner = random_.below(complex_.vertex_count());
        complex_.simplices.push_back(simplex);
        break;
      default:  // edges and points
        if (triangles_only_) break;
        complex_.simplices.push_back({simplex[0], random_.below(complex_.vertex_count())});
        complex_.simplices.push_back({random_.below(complex_.vertex_count())});
    }
  }

  void weld(std::uint64_t a, std::uint64_t b) {
    for (Simplex& simplex : complex_.simplices) std::replace(simplex.begin(), simplex.end(), a, b);
  }

  void renumber() {
    std::vector<std::uint64_t> number(complex_.vertex_count());
    for (std::uint64_t v = 0; v < number.size(); ++v) number[v] = v;
    random_.shuffle(number);
    const auto positions = complex_.positions;
    for (std::uint64_t v = 0; v < number.size(); ++v) complex_.positions[number[v]] = positions[v];
    for (Simplex& simplex : complex_.simplices)
      for (std::uint64_t& corner : simplex) corner = number[corner];
  }

  Random random_;
  bool triangles_only_;
  Complex complex_;
};

}  // namespace

Complex damaged_surface(std::uint64_t seed, bool triangles_only) { return Damage(seed, triangles_only).make(); }

}  // namespace reeb::test
