// Runs that are told that a surface is a manifold: the same bytes, or an error that names an edge with three triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"
#include "tests/support/whole_run.h"

namespace reeb::test {
namespace {

using Edge = std::pair<std::uint64_t, std::uint64_t>;

std::vector<Edge> edges_of(std::vector<std::uint64_t> simplex) {
  std::sort(simplex.begin(), simplex.end());
  simplex.erase(std::unique(simplex.begin(), simplex.end()), simplex.end());
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < simplex.size(); ++i)
    for (std::size_t j = i + 1; j < simplex.size(); ++j) edges.emplace_back(simplex[i], simplex[j]);
  return edges;
}

// How many edges and triangles of the complex, degenerate ones included, have the edge.
std::map<Edge, int> uses_of_edges(const Complex& complex) {
  std::map<Edge, int> uses;
  for (const auto& simplex : complex.simplices)
    for (const Edge& edge : edges_of(simplex)) ++uses[edge];
  return uses;
}

// What is left of it without simplices of higher dimension, and without those that come third at an edge.
Complex manifold_part(Complex complex) {
  std::map<Edge, int> uses;
  std::erase_if(complex.simplices, [&](const std::vector<std::uint64_t>& simplex) {
    const std::vector<Edge> edges = edges_of(simplex);
    if (simplex.size() > 3 || std::ranges::any_of(edges, [&](const Edge& e) { return uses[e] == 2; })) return true;
    for (const Edge& edge : edges) ++uses[edge];
    return false;
  });
  return complex;
}

class ManifoldRuns : public testing::Test {
 protected:
  std::string bytes(const ComplexMesh& mesh, const RunShape& shape, bool manifold) {
    runner_.options().buckets = 0;
    runner_.options().manifold = manifold;
    return take_bytes(runner_.run(mesh, shape, {3}, 1)[0]);
  }
  // The edge that the error of a run names.
  Edge named_edge(const ComplexMesh& mesh, const RunShape& shape) {
    try {
      bytes(mesh, shape, true);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      std::smatch match;
      const std::regex form("the edge between vertices ([0-9]+) and ([0-9]+) has a third triangle");
      if (std::regex_match(error.message(), match, form)) return {std::stoull(match[1]), std::stoull(match[2])};
      ADD_FAILURE() << error.what();
      return {};
    }
    ADD_FAILURE() << "the third triangle went unnoticed";
    return {};
  }

  const std::vector<RunShape> shapes_ = all_shapes();
  Runner runner_;
};

TEST_F(ManifoldRuns, GiveTheSameBytesWhereNoEdgeHasAThirdTriangle) {
  const std::uint64_t seed = base_seed(), cases = case_count(3000);
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    const Complex complex = manifold_part(random_complex(seed + i));
    const ComplexMesh mesh(complex);
    const RunShape &shape = shapes_[i % shapes_.size()], &other = shapes_[(i / 3 + 7) % shapes_.size()];
    EXPECT_TRUE(bytes(mesh, shape, true) == bytes(mesh, other, false)) << "case " << i << ", " << shape << '\n'
                                                                       << describe(complex);
  }
}

TEST_F(ManifoldRuns, NameAnEdgeWithThreeTrianglesWhereThereIsOne) {
  const std::uint64_t seed = base_seed() + 1'000'000, cases = case_count(3000);
  std::uint64_t found = 0;
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    // One simplex more than fits, somewhere.
    Complex complex = manifold_part(random_complex(seed + i));
    std::map<Edge, int> uses = uses_of_edges(complex);
    const auto full = std::ranges::find_if(uses, [](const auto& use) { return use.second == 2; });
    if (full == uses.end()) continue;
    Random random(seed + i);
    const Edge edge = full->first;
    const std::vector<std::uint64_t> third[] = {
        {edge.first, edge.second}, {edge.second, edge.first, edge.first}, {edge.first, edge.second, 0}};
    complex.simplices.insert(
        complex.simplices.begin() + static_cast<std::ptrdiff_t>(random.below(complex.simplices.size() + 1)),
        third[i % 3]);
    const RunShape& shape = shapes_[i % shapes_.size()];
    const Edge named = named_edge(ComplexMesh(complex), shape);
    EXPECT_GT(uses_of_edges(complex)[named], 2) << "case " << i << ", " << shape << '\n' << describe(complex);
    ++found;
  }
  EXPECT_GT(found, cases / 10);
}

}  // namespace
}  // namespace reeb::test
