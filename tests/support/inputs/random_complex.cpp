#include "tests/support/inputs/random_complex.h"

#include <algorithm>
#include <limits>

#include "tests/support/inputs/shapes.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

// A length, mostly small: the side of a grid, or the root of a number of vertices.
std::size_t random_side(Random& random) {
  const std::uint64_t size = random.below(300);
  if (size == 0) return random.between(8, 16);
  if (size < 20) return random.between(4, 7);
  return random.between(1, 4);
}

std::size_t random_count(Random& random) { return random_side(random) * random_side(random) + random.below(3); }

// Simplices with random corners, which may repeat; the number of corners is within the bounds.
Complex random_soup(Random& random, std::size_t least_corners, std::size_t most_corners) {
  Complex complex;
  complex.positions.resize(1 + random_count(random));
  complex.simplices.resize(random_count(random));
  for (auto& simplex : complex.simplices) {
    simplex.resize(random.between(least_corners, most_corners));
    for (std::uint64_t& corner : simplex) corner = random.below(complex.vertex_count());
  }
  complex.kind = "soup of " + std::to_string(least_corners) + " to " + std::to_string(most_corners) + " corners";
  return complex;
}

// A path of simplices of one dimension, each sharing all but one corner with the one before.
Complex random_stack(Random& random) {
  Complex complex;
  const std::size_t corners = random.between(3, 6);
  std::vector<std::uint64_t> simplex(corners);
  for (std::size_t i = 0; i < corners; ++i) simplex[i] = i;
  std::uint64_t vertices = corners;
  for (std::size_t n = random.between(1, 12); n > 0; --n) {
    complex.simplices.push_back(simplex);
    simplex[random.below(corners)] = vertices++;
  }
  complex.positions.resize(vertices);
  complex.kind = "stack of simplices with " + std::to_string(corners) + " corners";
  return complex;
}

Complex random_grid(Random& random) {
  const auto gluing = static_cast<Gluing>(random.below(kGluings));
  Complex complex = glued_grid(random_side(random), random_side(random), gluing);
  if (random.chance(30)) {  // holes
    std::erase_if(complex.simplices, [&](const auto&) { return random.chance(25); });
    complex.kind += " with holes";
  }
  return complex;
}

// Several fans at one vertex, which makes it a non-manifold vertex.
Complex random_fans(Random& random) {
  Complex complex = fan(random.between(1, 8), random.chance(50));
  for (std::uint64_t n = random.below(3); n > 0; --n) {
    const std::uint64_t center = complex.vertex_count();
    complex = disjoint_union(complex, fan(random.between(1, 8), random.chance(50)));
    for (auto& simplex : complex.simplices) std::replace(simplex.begin(), simplex.end(), center, std::uint64_t{0});
  }
  return complex;
}

Complex random_shape(Random& random) {
  switch (random.below(14)) {
    case 0:
      return random_soup(random, 3, 3);
    case 1:
      return random_soup(random, 2, 2);
    case 2:
      return random_soup(random, 1, 4);
    case 3:
      return random_soup(random, 4, 6);
    case 4:
      return random_stack(random);
    case 5:
      return random_fans(random);
    case 6:
      return book(random.between(1, 12));
    case 7:
      return closed_surface(static_cast<unsigned>(random.below(4)), random.between(3, 5), random.between(3, 4));
    case 8:
      return tied_strip(random.between(1, 12), random.between(1, 4));
    case 9:
      return random_soup(random, 2, 3);
    default:
      return random_grid(random);
  }
}

void identify_vertices(Complex& complex, Random& random) {
  for (std::uint64_t n = random.between(1, 3); n > 0; --n) {
    const std::uint64_t from = random.below(complex.vertex_count());
    const std::uint64_t to = random.below(complex.vertex_count());
    for (auto& simplex : complex.simplices) std::replace(simplex.begin(), simplex.end(), from, to);
  }
  complex.kind += ", pinched";
}

void add_loose_parts(Complex& complex, Random& random) {
  complex.positions.resize(complex.vertex_count() + random.below(3));
  const auto any = [&] { return random.below(complex.vertex_count()); };
  if (complex.vertex_count() == 0) return;
  for (std::uint64_t n = random.below(4); n > 0; --n) {
    const std::uint64_t a = any();
    switch (random.below(4)) {
      case 0:
        complex.simplices.push_back({a});
        break;
      case 1:
        complex.simplices.push_back({a, any()});
        break;
      case 2:
        complex.simplices.push_back({a, any(), a});
        break;
      default:
        complex.simplices.push_back({a, a, a});
        break;
    }
  }
  complex.kind += ", loose parts";
}

void repeat_simplices(Complex& complex, Random& random) {
  for (std::uint64_t n = random.between(1, 4); n > 0 && !complex.simplices.empty(); --n) {
    auto copy = complex.simplices[random.below(complex.simplices.size())];
    random.shuffle(copy);
    complex.simplices.push_back(std::move(copy));
  }
  complex.kind += ", repeats";
}

void renumber_vertices(Complex& complex, Random& random) {
  std::vector<std::uint64_t> number(complex.vertex_count());
  for (std::size_t v = 0; v < number.size(); ++v) number[v] = v;
  random.shuffle(number);
  auto positions = complex.positions;
  for (std::size_t v = 0; v < number.size(); ++v) positions[number[v]] = complex.positions[v];
  complex.positions = std::move(positions);
  for (auto& simplex : complex.simplices)
    for (std::uint64_t& corner : simplex) corner = number[corner];
  complex.kind += ", renumbered";
}

using Limits = std::numeric_limits<double>;

double pick(Random& random, const std::vector<double>& choices) { return choices[random.below(choices.size())]; }

double random_value(Random& random, std::uint64_t kind, std::size_t vertex, std::size_t period) {
  const auto index = static_cast<double>(vertex);
  switch (kind) {
    case 0:
      return pick(random, {0.0, 1.0});
    case 1:
      return 7.25;
    case 2:
      return index;
    case 3:
      return -index;
    case 4:
      return static_cast<double>(vertex / period);
    case 5:
      return static_cast<double>(vertex % period);
    case 6:
      return pick(random, {-0.0, 0.0});
    case 7:
      return pick(random, {-1.0, -0.0, 0.0, 1.0});
    case 8:
      return static_cast<double>(random.below(5)) * Limits::denorm_min();
    case 9:
      return pick(random, {Limits::lowest(), -1e308, 1e308, Limits::max(), 0.0});
    case 10:
      return static_cast<double>(random.below(4));
    default:
      return random.unit() - 0.5;
  }
}

}  // namespace

void set_random_values(Complex& complex, std::uint64_t seed) {
  Random random(seed);
  const std::uint64_t kind = random.below(20);
  const std::size_t period = random.between(1, 6);
  complex.values.resize(complex.vertex_count());
  for (std::size_t v = 0; v < complex.vertex_count(); ++v) complex.values[v] = random_value(random, kind, v, period);
  complex.kind += ", values " + std::to_string(kind);
}

Complex random_complex(std::uint64_t seed) {
  Random random(seed);
  Complex complex;
  if (random.below(200) != 0) complex = random_shape(random);
  if (random.chance(20)) complex = disjoint_union(complex, random_shape(random));
  if (random.chance(20) && complex.vertex_count() > 0) identify_vertices(complex, random);
  if (random.chance(25)) add_loose_parts(complex, random);
  if (random.chance(20)) repeat_simplices(complex, random);
  if (random.chance(40)) renumber_vertices(complex, random);
  if (random.chance(50)) complex = shuffled(std::move(complex), random.next());
  for (std::size_t v = 0; v < complex.vertex_count(); ++v)
    complex.positions[v] = {random.unit(), random.unit(), static_cast<double>(v)};
  set_random_values(complex, random.next());
  complex.kind += ", seed " + std::to_string(seed);
  return complex;
}

}  // namespace reeb::test
