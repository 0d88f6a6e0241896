#include "io/fields/whole_complex.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// Reserves what the arrays may grow to, before they grow. A vector that grows holds its old and its new array for a
// moment.
class Growth {
 public:
  explicit Growth(Reservation& memory) : memory_(memory) {}

  template <class T>
  void make_room(std::vector<T>& items, std::size_t more) {
    if (items.capacity() - items.size() >= more) return;
    const std::size_t capacity = items.size() + std::max(more, items.size() / 2);
    memory_.resize(memory_.bytes() + capacity * sizeof(T));
    const std::size_t before = items.capacity();
    items.reserve(capacity);
    memory_.resize(memory_.bytes() - before * sizeof(T));
  }

 private:
  Reservation& memory_;
};

// The index of the vertex in the complex.
std::uint32_t index_of(const VertexNumbering& numbers, VertexId v) {
  if (!numbers.has_gaps()) return static_cast<std::uint32_t>(v.value());
  const auto index = numbers.index_of(v.value());
  if (!index) throw input_changed();
  return static_cast<std::uint32_t>(*index);
}

void append_edges(std::span<const VertexId> simplex, WholeComplex& complex) {
  for (std::size_t i = 0; i < simplex.size(); ++i)
    for (std::size_t j = i + 1; j < simplex.size(); ++j)
      if (simplex[i] != simplex[j])
        complex.edges.push_back({index_of(complex.numbers, simplex[i]), index_of(complex.numbers, simplex[j])});
}

void append(const MeshBatch& batch, WholeComplex& complex, Growth& growth) {
  complex.numbers.append(batch.first_vertex.value(), batch.vertex_count);
  growth.make_room(complex.coordinates, batch.vertex_count * complex.dimension);
  for (std::size_t i = 0; i < batch.vertex_count; ++i)
    for (const auto& column : batch.coordinates) complex.coordinates.push_back(column[i]);
  const auto append_simplices = [&](std::span<const VertexId> corners, std::size_t k) {
    const std::size_t count = corners.size() / (k + 1);
    if (count != 0 && k != 2) complex.is_surface = false;
    if (count != 0 && k > 2) complex.has_cells = true;
    if (k == 2)
      growth.make_room(complex.triangles, count);
    else
      growth.make_room(complex.edges, count * k * (k + 1) / 2);
    for (std::size_t s = 0; s < count; ++s) {
      const auto simplex = corners.subspan(s * (k + 1), k + 1);
      if (k == 2 && simplex[0] != simplex[1] && simplex[1] != simplex[2] && simplex[2] != simplex[0]) {
        complex.triangles.push_back({index_of(complex.numbers, simplex[0]), index_of(complex.numbers, simplex[1]),
                                     index_of(complex.numbers, simplex[2])});
        continue;
      }
      if (k == 2) growth.make_room(complex.edges, 2);  // a degenerate triangle is at most an edge, twice
      append_edges(simplex, complex);
    }
  };
  for (std::size_t k = 1; k < batch.simplices.size(); ++k) append_simplices(batch.simplices[k], k);
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t v) {
  while (parents[v] != v) v = parents[v] = parents[parents[v]];
  return v;
}

}  // namespace

double WholeComplex::length(std::uint32_t a, std::uint32_t b) const {
  double sum = 0;
  for (unsigned k = 0; k < dimension; ++k) {
    const double step = coordinates[std::size_t{a} * dimension + k] - coordinates[std::size_t{b} * dimension + k];
    sum += step * step;
  }
  return std::sqrt(sum);
}

void use_unit_of_edges(WholeComplex& complex) {
  double longest = 0;  // half of a step of a coordinate, which is always finite
  const auto look = [&](std::uint32_t a, std::uint32_t b) {
    for (unsigned k = 0; k < complex.dimension; ++k)
      longest = std::max(longest, std::abs(complex.coordinates[std::size_t{a} * complex.dimension + k] / 2 -
                                           complex.coordinates[std::size_t{b} * complex.dimension + k] / 2));
  };
  for (const auto& t : complex.triangles) look(t[0], t[1]), look(t[1], t[2]), look(t[2], t[0]);
  for (const auto& e : complex.edges) look(e[0], e[1]);
  if (longest == 0) return;
  const int exponent = std::ilogb(longest) + 1;
  for (double& x : complex.coordinates) x = std::ldexp(x, -exponent);
  complex.unit_exponent += exponent;
}

void require_numbers(std::uint64_t count, const char* items) {
  if (count < std::numeric_limits<std::uint32_t>::max()) return;
  throw Error(ErrorKind::kResource,
              std::string("the mesh has too many ") + items + " for a function that needs all of it",
              "choose a function of single vertices, or give the values with file:PATH");
}

WholeComplex read_whole(MeshReader& reader, MemoryBudget& budget) {
  WholeComplex complex;
  complex.dimension = reader.info().dimension;
  complex.memory = budget.reserve("whole mesh", 0);
  Growth growth(complex.memory);
  MeshBatch batch;
  while (reader.read(batch)) {
    append(batch, complex, growth);
    require_numbers(complex.coordinates.size() / complex.dimension, "vertices");
    require_numbers(complex.triangles.size(), "triangles");
    require_numbers(complex.edges.size(), "edges");
  }
  complex.number_count = reader.info().number_count.value_or(complex.vertex_count());
  use_unit_of_edges(complex);
  return complex;
}

Components components_of(const WholeComplex& complex) {
  Components result;
  auto& parents = result.of_vertex;
  parents.resize(complex.vertex_count());
  std::iota(parents.begin(), parents.end(), 0u);
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t low = root_of(parents, a), high = root_of(parents, b);
    parents[std::max(low, high)] = std::min(low, high);
  };
  for (const auto& t : complex.triangles) join(t[0], t[1]), join(t[1], t[2]);
  for (const auto& e : complex.edges) join(e[0], e[1]);
  // A root is the lowest vertex of its component, so it has its number before the others need it.
  std::vector<std::uint32_t> numbers(parents.size());
  for (std::uint32_t v = 0; v < parents.size(); ++v) {
    const std::uint32_t root = root_of(parents, v);
    numbers[v] = root == v ? result.count++ : numbers[root];
  }
  parents = std::move(numbers);
  return result;
}

}  // namespace reeb::io
