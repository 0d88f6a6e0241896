#include "ooc/census/mesh_census.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
#include "tests/model/reference_census.h"
#include "tests/support/inputs/complex_mesh.h"
#include "tests/support/inputs/damaged_surface.h"
#include "tests/support/random.h"
#include "tests/support/scratch.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

using test::Complex;
using test::ReferenceCensus;
using test::VertexSet;

VertexSet vertices_of(const CensusPlace& place) {
  VertexSet vertices;
  for (const VertexId v : place.vertices) vertices.push_back(v.value());
  return vertices;
}

void expect_position(const CensusPlace& place, const Complex& complex) {
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    for (const VertexId v : place.vertices) sum += complex.positions[v.value()][k];
    EXPECT_NEAR(place.position[k], sum / static_cast<double>(place.vertices.size()), 1e-9);
  }
}

// The first places of a sorted list.
void expect_places(const CensusCount& found, const std::vector<VertexSet>& expected, const Complex& complex,
                   const char* what) {
  SCOPED_TRACE(what);
  std::vector<VertexSet> places,
      first(expected.begin(),
            expected.begin() + static_cast<std::ptrdiff_t>(std::min(expected.size(), CensusCount::kMostPlaces)));
  for (const CensusPlace& place : found.places) {
    places.push_back(vertices_of(place));
    expect_position(place, complex);
  }
  EXPECT_EQ(places, first);
}

void expect_same(const CensusCount& found, const std::set<VertexSet>& expected, const Complex& complex,
                 const char* what) {
  EXPECT_EQ(found.count, expected.size()) << what;
  expect_places(found, {expected.begin(), expected.end()}, complex, what);
}

void expect_same(const CensusCount& found, const std::map<VertexSet, std::uint64_t>& expected, const Complex& complex,
                 const char* what) {
  std::uint64_t count = 0;
  std::vector<VertexSet> places;
  for (const auto& [place, times] : expected) {
    places.push_back(place);
    count += times;
  }
  EXPECT_EQ(found.count, count) << what;
  expect_places(found, places, complex, what);
}

void expect_same_components(const MeshCensus& found, const ReferenceCensus& expected) {
  EXPECT_EQ(found.components, expected.components.size());
  auto all = expected.components;
  std::ranges::stable_sort(all, std::ranges::greater(), &test::ReferenceComponent::triangles);
  all.resize(std::min(all.size(), CensusCount::kMostPlaces));
  ASSERT_EQ(found.largest_components.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(found.largest_components[i].triangles, all[i].triangles);
    EXPECT_EQ(found.largest_components[i].vertices, all[i].vertices);
    EXPECT_EQ(vertices_of(found.largest_components[i].first), VertexSet{all[i].lowest});
  }
}

// Lengths are sums in another order, so boundaries of nearly the same length can be in another order, too.
void expect_same_boundaries(const MeshCensus& found, const ReferenceCensus& expected) {
  EXPECT_EQ(found.boundaries, expected.boundaries.size());
  const std::size_t listed = std::min(expected.boundaries.size(), CensusCount::kMostPlaces);
  ASSERT_EQ(found.longest_boundaries.size(), listed);
  std::vector<double> lengths;
  for (const test::ReferenceBoundary& boundary : expected.boundaries) lengths.push_back(boundary.length);
  std::ranges::sort(lengths, std::ranges::greater());
  for (std::size_t i = 0; i < listed; ++i) {
    const CensusBoundary& boundary = found.longest_boundaries[i];
    EXPECT_NEAR(boundary.length, lengths[i], 1e-9 * lengths[i]);
    const auto same =
        std::ranges::find(expected.boundaries, boundary.first.vertices.at(0).value(), &test::ReferenceBoundary::lowest);
    ASSERT_NE(same, expected.boundaries.end());
    EXPECT_EQ(boundary.edges, same->edges);
    EXPECT_NEAR(boundary.length, same->length, 1e-9 * same->length);
    EXPECT_EQ(boundary.min, same->min);
    EXPECT_EQ(boundary.max, same->max);
  }
}

void expect_same(const MeshCensus& found, const ReferenceCensus& expected, const Complex& complex) {
  EXPECT_EQ(found.not_a_surface, "");
  EXPECT_EQ(found.vertices, complex.vertex_count());
  expect_same_components(found, expected);
  expect_same_boundaries(found, expected);
  expect_same(found.nonmanifold_edges, expected.nonmanifold_edges, complex, "non-manifold edges");
  expect_same(found.nonmanifold_vertices, expected.nonmanifold_vertices, complex, "non-manifold vertices");
  expect_same(found.degenerate, expected.degenerate, complex, "degenerate");
  expect_same(found.duplicates, expected.duplicates, complex, "duplicates");
  expect_same(found.folded, expected.folded, complex, "folded");
  EXPECT_EQ(found.loose_edges, expected.loose_edges.size());
  EXPECT_EQ(found.euler, expected.euler);
  EXPECT_EQ(found.closed, expected.closed);
  EXPECT_EQ(found.orientable, expected.orientable);
  EXPECT_EQ(found.oriented, expected.oriented);
  EXPECT_EQ(found.genus, expected.genus);
  EXPECT_EQ(found.genus.has_value(), found.why_no_genus.empty());
}

enum class Form { kIndexed, kStream, kSpooled };

MeshCensus census_of(const test::ComplexMesh& mesh, Form form, std::uint64_t seed, std::uint64_t memory,
                     CensusOptions options) {
  static const Scratch scratch;
  Workspace space(scratch.path(), memory);
  const auto take = [&] {
    if (form == Form::kIndexed) {
      test::IndexedComplex indexed(mesh);
      return take_census(indexed, 3, space, options);
    }
    test::ComplexStream stream(mesh, seed);
    test::UnfinalizedComplex plain(mesh, seed);
    options.read_again = [&] { return std::make_unique<test::ComplexStream>(mesh, seed); };
    return take_census(form == Form::kStream ? static_cast<MeshReader&>(stream) : plain, space, options);
  };
  MeshCensus census = take();
  EXPECT_EQ(space.budget.used_bytes(), 0);
  EXPECT_LE(space.budget.peak_bytes(), memory);
  EXPECT_EQ(census.simplices, mesh.counts);
  return census;
}

TEST(MeshCensus, DamagedSurfacesAreCountedAsTheDefinitionsSay) {
  const std::uint64_t base = test::base_seed(), cases = test::case_count(1000);
  std::uint64_t with_genus = 0, folded = 0, twisted = 0;
  for (std::uint64_t i = 0; i < cases && !testing::Test::HasFailure(); ++i) {
    const std::uint64_t seed = base + i;
    const bool triangles_only = i % 3 == 0;
    const Complex complex = test::damaged_surface(seed, triangles_only);
    SCOPED_TRACE("damaged_surface(" + std::to_string(seed) + ", " + (triangles_only ? "true" : "false") + ")");
    const ReferenceCensus expected = test::reference_census(complex);
    with_genus += expected.genus.has_value() ? 1u : 0u;
    folded += expected.folded.empty() ? 0u : 1u;
    twisted += expected.orientable == false ? 1u : 0u;
    const test::ComplexMesh mesh(complex);
    test::Random random(seed);
    for (const Form form : {Form::kIndexed, Form::kStream, Form::kSpooled}) {
      if (form == Form::kIndexed && !triangles_only) continue;
      SCOPED_TRACE(static_cast<int>(form));
      CensusOptions options;
      options.chunk_triangles = static_cast<std::size_t>(random.between(1, 40));
      options.background = i % 64 == 0;
      const std::uint64_t memory = random.chance(50) ? MemoryBudget::kUnlimited : 16 << 20;
      expect_same(census_of(mesh, form, seed, memory, options), expected, complex);
    }
  }
  EXPECT_GT(with_genus, cases / 10);
  EXPECT_GT(folded, cases / 10);
  EXPECT_GT(twisted, cases / 50);
}

TEST(MeshCensus, CopiesThatDisagreeAreNotOriented) {
  // Alone, and with a neighbour across an edge.
  const std::vector<std::vector<VertexSet>> surfaces = {{{0, 1, 2}, {0, 2, 1}},
                                                        {{0, 1, 2}, {1, 2, 0}},
                                                        {{0, 1, 2}, {0, 2, 1}, {1, 3, 2}},
                                                        {{0, 1, 2}, {1, 2, 0}, {1, 3, 2}}};
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    SCOPED_TRACE(i);
    Complex complex;
    complex.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    complex.simplices = surfaces[i];
    complex.values.assign(complex.vertex_count(), 0);
    const ReferenceCensus expected = test::reference_census(complex);
    EXPECT_EQ(expected.oriented, i % 2 == 1);
    const test::ComplexMesh mesh(complex);
    for (const Form form : {Form::kIndexed, Form::kStream, Form::kSpooled})
      expect_same(census_of(mesh, form, 1, MemoryBudget::kUnlimited, {}), expected, complex);
  }
}

// A grid with some damage, in random order: nearly all of its vertices are in use at once.
Complex large_surface() {
  constexpr std::uint64_t kSide = 120;
  Complex complex;
  test::Random random(7);
  for (std::uint64_t j = 0; j < kSide; ++j)
    for (std::uint64_t i = 0; i < kSide; ++i)
      complex.positions.push_back({static_cast<double>(i), static_cast<double>(j), random.unit()});
  for (std::uint64_t j = 0; j + 1 < kSide; ++j)
    for (std::uint64_t i = 0; i + 1 < kSide; ++i) {
      const std::uint64_t v = i + kSide * j;
      if (!random.chance(2)) complex.simplices.push_back({v, v + 1, v + kSide});
      if (!random.chance(2)) complex.simplices.push_back({v + 1, v + 1 + kSide, v + kSide});
      if (random.chance(1)) complex.simplices.push_back({v, v + kSide, v + 1});
      if (random.chance(1)) complex.simplices.push_back({v, v + 1, v + kSide + 1});
      if (random.chance(1)) complex.simplices.push_back({v, v + 1, v});
    }
  random.shuffle(complex.simplices);
  complex.values.assign(complex.vertex_count(), 0);
  return complex;
}

TEST(MeshCensus, AMeshWhoseFrontIsTooLargeForTheMemoryIsSortedFirst) {
  const Complex complex = large_surface();
  const ReferenceCensus expected = test::reference_census(complex);
  const test::ComplexMesh mesh(complex);
  for (const Form form : {Form::kIndexed, Form::kStream, Form::kSpooled})
    for (const std::uint64_t memory : {MemoryBudget::kUnlimited, std::uint64_t{4} << 20}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(form)) + " in " + std::to_string(memory));
      bool sorted = false, again = false;
      CensusOptions options;
      options.progress = [&](const CensusProgress& at) {
        sorted = sorted || at.phase == CensusProgress::Phase::kSort;
        again = again || at.phase == CensusProgress::Phase::kSpool;
      };
      expect_same(census_of(mesh, form, 1, memory, options), expected, complex);
      EXPECT_EQ(sorted, memory != MemoryBudget::kUnlimited);
      EXPECT_EQ(again, form == Form::kSpooled || (form == Form::kStream && sorted));
    }
}

TEST(MeshCensus, TheMemoryIsThatOfTheFront) {
  constexpr std::uint64_t kColumns = 10, kRows = 20000;
  Complex complex;
  for (std::uint64_t j = 0; j < kRows; ++j)
    for (std::uint64_t i = 0; i < kColumns; ++i) {
      const std::uint64_t v = complex.vertex_count();
      complex.positions.push_back({static_cast<double>(i), static_cast<double>(j), 0});
      if (i == 0 || j == 0) continue;
      complex.simplices.push_back({v - 1 - kColumns, v - kColumns, v});
      complex.simplices.push_back({v - 1 - kColumns, v, v - 1});
    }
  complex.values.assign(complex.vertex_count(), 0);
  const test::ComplexMesh mesh(complex);
  CensusOptions options;
  options.chunk_triangles = 2 * (kColumns - 1);
  options.progress = [](const CensusProgress& at) { EXPECT_NE(at.phase, CensusProgress::Phase::kSort); };
  const MeshCensus census = census_of(mesh, Form::kIndexed, 1, 2 << 20, options);
  EXPECT_EQ(census.boundaries, 1);
  EXPECT_EQ(census.longest_boundaries.at(0).length, 2 * (kColumns - 1 + kRows - 1));
  EXPECT_EQ(census.folded.count, 0);
  EXPECT_EQ(census.genus, 0);
}

Complex one_simplex(std::size_t corners) {
  Complex complex;
  complex.simplices.emplace_back();
  for (std::size_t k = 0; k < corners; ++k) {
    complex.simplices.back().push_back(k);
    complex.positions.push_back({static_cast<double>(k), 0, 0});
    complex.values.push_back(0);
  }
  complex.positions.push_back({});
  complex.values.push_back(0);
  return complex;
}

TEST(MeshCensus, OfCellsOnlyComponentsAreCounted) {
  const Complex complex = one_simplex(4);
  const test::ComplexMesh mesh(complex);
  for (const Form form : {Form::kStream, Form::kSpooled}) {
    const MeshCensus census = census_of(mesh, form, 1, MemoryBudget::kUnlimited, {});
    EXPECT_EQ(census.not_a_surface, "it has cells");
    EXPECT_EQ(census.why_no_genus, "it is not a surface: it has cells");
    EXPECT_EQ(census.components, 2);
    EXPECT_EQ(census.vertices, 5);
    EXPECT_EQ(census.unused_vertices, 1);
    EXPECT_TRUE(census.largest_components.empty());
  }
}

TEST(MeshCensus, WhyThereIsNoGenus) {
  const auto why = [](const Complex& complex) {
    return census_of(test::ComplexMesh(complex), Form::kSpooled, 1, MemoryBudget::kUnlimited, {}).why_no_genus;
  };
  const auto why_with = [&](std::vector<std::vector<std::uint64_t>> simplices) {
    Complex complex;
    complex.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}};
    complex.values.assign(5, 0);
    complex.simplices = std::move(simplices);
    return why(complex);
  };
  EXPECT_EQ(why({}), "it has no triangles");
  EXPECT_EQ(why(one_simplex(2)), "it has no triangles");
  EXPECT_EQ(why(one_simplex(3)), "");
  EXPECT_EQ(why_with({{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}), "it has 1 non-manifold edge");
  EXPECT_EQ(why_with({{0, 1, 2}, {0, 3, 4}}), "it has 1 non-manifold vertex");
  EXPECT_EQ(why_with({{0, 1, 2}, {3, 4}}), "it has 1 edge of no triangle");
  EXPECT_EQ(why_with({{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}}), "it is not orientable");
}

// A stream that names a vertex which it has finalized.
class WrongStream : public test::ComplexStream {
 public:
  explicit WrongStream(const test::ComplexMesh& mesh) : ComplexStream(mesh, 1) {}
  bool read(MeshBatch& batch) override {
    batch.clear();
    if (step_ == 2) return false;
    batch.coordinates.assign(3, std::vector<double>(step_ == 0 ? 3 : 0, 0.0));
    batch.vertex_count = step_ == 0 ? 3 : 0;
    batch.triangles() = {VertexId(0), VertexId(1), VertexId(2)};
    if (step_++ == 0) batch.finalized = {VertexId(0)};
    return true;
  }

 private:
  int step_ = 0;
};

TEST(MeshCensus, AVertexThatIsUsedAfterItWasFinalizedIsAnError) {
  const test::ComplexMesh mesh(one_simplex(3));
  const Scratch scratch;
  Workspace space(scratch.path(), MemoryBudget::kUnlimited);
  WrongStream stream(mesh);
  EXPECT_THROW(take_census(stream, space), Error);
}

}  // namespace
}  // namespace reeb::ooc
