// The triangles through the lowest vertex of a simplex give the graph of the whole complex, for every function.
#include "libreeb/port/deciding_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "libreeb/engine/online_reeb.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

// Simplices of one dimension with random corners, so that many share faces; the values have many ties.
Complex random_cells(Random& random, std::size_t dimension) {
  Complex complex;
  const std::size_t vertices = dimension + 1 + random.below(2 * dimension + 3);
  for (std::size_t v = 0; v < vertices; ++v) {
    complex.positions.emplace_back();
    complex.values.push_back(static_cast<double>(random.below(random.chance(50) ? 4 : 1000)));
  }
  complex.simplices.resize(random.between(1, 6));
  for (auto& simplex : complex.simplices) {
    std::vector<std::uint64_t> all(vertices);
    for (std::size_t v = 0; v < vertices; ++v) all[v] = v;
    random.shuffle(all);
    simplex.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(dimension + 1));
    if (random.chance(10)) simplex[random.below(simplex.size())] = simplex[0];
  }
  return complex;
}

MeshBatch batch_of(const Complex& complex) {
  MeshBatch batch;
  for (const auto& simplex : complex.simplices)
    for (const std::uint64_t v : simplex) batch.simplices[simplex.size() - 1].emplace_back(v);
  return batch;
}

ReebGraph graph_of(const Complex& complex, const MeshBatch& batch) {
  OnlineReeb engine;
  for (const double value : complex.values) engine.add_vertex(value);
  batch.for_each_simplex([&engine](std::span<const VertexId> corners) { engine.add_simplex(corners); });
  engine.finish();
  return without_positions(engine.snapshot());
}

TEST(DecidingTriangles, GiveTheGraphOfTheDefinition) {
  const std::uint64_t seed = base_seed(), cases = case_count(2000);
  for (std::size_t dimension = 1; dimension <= 5; ++dimension)
    for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
      Random random(seed + 1000 * i + dimension);
      const Complex complex = random_cells(random, dimension);
      const ReebGraph expected = without_positions(reference_reeb(complex));
      MeshBatch batch = batch_of(complex);
      EXPECT_EQ(graph_of(complex, batch), expected) << "simplex by simplex, seed " << seed + 1000 * i + dimension;
      DecidingTriangles deciding;
      deciding.reduce(batch);
      EXPECT_EQ(batch.simplex_count(), batch.triangle_count());
      EXPECT_EQ(graph_of(complex, batch), expected) << "reduced to triangles, seed " << seed + 1000 * i + dimension;
    }
}

TEST(DecidingTriangles, AreThoseThroughTheLowestVertexEachOnce) {
  for (std::size_t dimension = 3; dimension <= kMaxSimplexDimension; ++dimension) {
    MeshBatch batch;
    for (std::size_t v = dimension + 1; v-- > 0;) batch.simplices[dimension].emplace_back(7 + v);
    batch.simplices[dimension].insert(batch.simplices[dimension].end(), batch.simplices[dimension].begin(),
                                      batch.simplices[dimension].begin() + static_cast<std::ptrdiff_t>(dimension + 1));
    DecidingTriangles deciding;
    deciding.reduce(batch);
    EXPECT_EQ(batch.triangle_count(), dimension * (dimension - 1) / 2) << "the same simplex twice";
    std::set<std::pair<VertexId, VertexId>> others;
    for (std::size_t t = 0; t < batch.triangles().size(); t += 3) {
      EXPECT_EQ(batch.triangles()[t], VertexId(7));
      others.emplace(batch.triangles()[t + 1], batch.triangles()[t + 2]);
    }
    EXPECT_EQ(others.size(), batch.triangle_count());
  }
}

TEST(DecidingTriangles, TrianglesStayAsTheyAre) {
  MeshBatch batch;
  batch.triangles() = {VertexId(2), VertexId(2), VertexId(1), VertexId(3), VertexId(1), VertexId(0)};
  batch.edges() = {VertexId(3), VertexId(2)};
  batch.points() = {VertexId(5)};
  std::vector<VertexId> expected = batch.triangles();
  expected.insert(expected.end(), {VertexId(5), VertexId(5), VertexId(5), VertexId(2), VertexId(3), VertexId(3)});
  DecidingTriangles().reduce(batch);
  EXPECT_EQ(batch.triangles(), expected);
  EXPECT_EQ(batch.simplex_count(), 4u);
}

}  // namespace
}  // namespace reeb::test
