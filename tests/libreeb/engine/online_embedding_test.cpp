// The embedding against its definition: every vertex is in the bucket of its value, on its arc; none is lost or counted
// twice, whatever the stream (docs/SEMANTICS.md, Conservation).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <tuple>

#include "tests/libreeb/engine/player.h"
#include "tests/libreeb/engine/streamed_mesh.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

constexpr std::size_t kBatches[] = {1, 3, 7, 4096};

struct Embedded {
  ArcKeys arc;
  std::vector<Bucket> buckets;
  int exponent;
  friend bool operator==(const Embedded&, const Embedded&) = default;
};

struct EmbeddedGraph {
  std::vector<SettledNode> nodes;
  std::vector<Embedded> arcs;
};

struct EmbeddingSink : GraphSink, EmbeddedGraph {
  void add_nodes(std::span<const SettledNode> more) override { nodes.insert(nodes.end(), more.begin(), more.end()); }
  void add_arcs(const SettledArcs& more) override {
    ASSERT_EQ(more.lists.ends.size(), more.arcs.size());
    ASSERT_EQ(more.lists.ends.back(), more.lists.bytes.size());
    for (std::size_t i = 0; i < more.arcs.size(); ++i) {
      arcs.push_back({more.arcs[i], {}, more.bucket_exponent});
      more.lists.unpack(i, arcs.back().buckets);
    }
  }
};

void expect_within_its_arc(const Embedded& embedded) {
  const auto& [arc, buckets, exponent] = embedded;
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    ASSERT_GT(buckets[i].count, 0u);
    ASSERT_GE(buckets[i].index, bucket_index(arc.lo.value, exponent));
    ASSERT_LE(buckets[i].index, bucket_index(arc.hi.value, exponent));
    if (i > 0) {
      ASSERT_LT(buckets[i - 1].index, buckets[i].index);
    }
  }
}

// Expects each vertex to be a node or in one bucket. Positions are at most about 1.
void expect_conserved(const EmbeddedGraph& sink, const std::vector<Point>& positions) {
  std::uint64_t count = sink.nodes.size();
  std::array<double, 3> sum{};
  for (const Embedded& embedded : sink.arcs) {
    expect_within_its_arc(embedded);
    for (const Bucket& bucket : embedded.buckets) {
      count += bucket.count;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<double>(bucket.count) * bucket.mean[k];
    }
  }
  ASSERT_EQ(count, positions.size());
  for (std::size_t k = 0; k < 3; ++k) {
    double all = 0, most = 1;
    for (const Point& position : positions) {
      all += position[k];
      most = std::max(most, std::abs(position[k]));
    }
    for (const SettledNode& node : sink.nodes) sum[k] += node.position[k];
    ASSERT_NEAR(sum[k], all, 1e-9 * most * static_cast<double>(positions.size()));
  }
}

double spread(const Complex& complex, Random& random) {
  if (complex.values.empty()) return 0;
  const auto [least, most] = std::minmax_element(complex.values.begin(), complex.values.end());
  return 2 * (*most / 2 - *least / 2) * random.unit();
}

TEST(Embedding, ConservesVerticesAndPositionsInAnyStream) {
  const std::uint64_t seed = base_seed(), cases = case_count(10'000);
  for (std::uint64_t i = 0; i < cases && !HasFatalFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    SCOPED_TRACE(describe(complex));
    Random random(seed + i);
    for (const std::size_t batch : kBatches) {
      const double noise_below = random.chance(50) ? spread(complex, random) : 0;
      const auto buckets = static_cast<std::uint32_t>(random.between(1, random.chance(50) ? 4 : 100));
      SCOPED_TRACE(testing::Message() << "batches of " << batch << ", noise below " << noise_below << ", " << buckets
                                      << " buckets");
      EmbeddingSink sink;
      OnlineReeb::Options options = any_waiting(batch, random);
      options.noise_below = noise_below;
      options.buckets = buckets;
      OnlineReeb engine(options, &sink);
      Player(complex, any_finalization(random), random.next()).play(engine);
      engine.finish();
      expect_conserved(sink, complex.positions);
      if (noise_below == 0) {
        ASSERT_EQ(sink.nodes.size(), reference_reeb(complex).node_count());
      }
    }
  }
}

// The content of a bucket on all arcs between two vertices. Parallel arcs cannot be distinguished.
using Place = std::tuple<std::uint64_t, std::uint64_t, std::int64_t>;
struct Contents {
  std::uint64_t count = 0;
  Point sum{};
  void add(std::uint64_t vertices, const Point& mean) {
    count += vertices;
    for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<double>(vertices) * mean[k];
  }
};

// The definition: if an edge is attached to a regular vertex, the vertex becomes a node of the Reeb graph. The two arcs
// at it other than that edge are the parts of the arc of the vertex.
std::map<Place, Contents> contents_by_definition(const Complex& complex, int exponent) {
  std::map<Place, Contents> contents;
  const ReebGraph graph = reference_reeb(complex);
  for (std::uint64_t v = 0; v < complex.vertex_count(); ++v) {
    if (std::any_of(graph.nodes.begin(), graph.nodes.end(),
                    [&](const SweepKey& node) { return node.vertex == VertexId(v); }))
      continue;
    Complex hairy = complex;
    const std::uint64_t hair = complex.vertex_count();
    hairy.values.push_back(complex.values[v]);
    hairy.positions.push_back({});
    hairy.simplices.push_back({v, hair});
    const ReebGraph with = reference_reeb(hairy);
    std::uint64_t lo = hair, hi = hair;
    for (std::size_t a = 0; a < with.arc_count(); ++a) {
      const std::uint64_t below = with.nodes[with.lo[a].value()].vertex.value();
      const std::uint64_t above = with.nodes[with.hi[a].value()].vertex.value();
      if (above == v) lo = below;
      if (below == v && above != hair) hi = above;
    }
    const double value = complex.values[v] == 0 ? 0.0 : complex.values[v];
    contents[{lo, hi, bucket_index(value, exponent)}].add(1, complex.positions[v]);
  }
  return contents;
}

TEST(Embedding, OfOneChunkEqualsTheDefinition) {
  const std::uint64_t seed = base_seed(), cases = case_count(2000);
  for (std::uint64_t i = 0; i < cases && !HasFatalFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    if (complex.vertex_count() == 0 || complex.vertex_count() > 60) continue;
    SCOPED_TRACE(describe(complex));
    Random random(seed + i);
    const auto buckets = static_cast<std::uint32_t>(random.between(1, 40));
    EmbeddingSink sink;
    OnlineReeb engine({.batch_triangles = 1'000'000, .buckets = buckets}, &sink);
    Player(complex, any_finalization(random), random.next()).play(engine);
    engine.finish();

    const auto [least, most] = std::minmax_element(complex.values.begin(), complex.values.end());
    const int exponent = bucket_exponent(*least, *most, buckets);
    const auto expected = contents_by_definition(complex, exponent);
    std::map<Place, Contents> found;
    for (const auto& [arc, its_buckets, its_exponent] : sink.arcs) {
      ASSERT_EQ(its_exponent, exponent);
      for (const Bucket& bucket : its_buckets)
        found[{arc.lo.vertex.value(), arc.hi.vertex.value(), bucket.index}].add(bucket.count, bucket.mean);
    }
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [place, contents] : expected) {
      ASSERT_EQ(found[place].count, contents.count);
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_NEAR(found[place].sum[k], contents.sum[k], 1e-9 * (1 + std::abs(contents.sum[k])));
    }
  }
}

constexpr std::uint32_t kBucketsOfMesh = 64;

EmbeddedGraph embed(const Mesh& mesh, std::size_t size, double noise_share = 0) {
  EmbeddingSink sink;
  stream(mesh, size, sink, [&](double min, double max) {
    return SweepOptions{noise_share * (max - min), bucket_exponent(min, max, kBucketsOfMesh)};
  });
  return sink;
}

std::map<std::pair<std::uint64_t, std::uint64_t>, double> vertices_by_arc(const EmbeddedGraph& sink) {
  std::map<std::pair<std::uint64_t, std::uint64_t>, double> vertices;
  for (const Embedded& embedded : sink.arcs)
    for (const Bucket& bucket : embedded.buckets)
      vertices[{embedded.arc.lo.vertex.value(), embedded.arc.hi.vertex.value()}] += static_cast<double>(bucket.count);
  return vertices;
}

TEST(Embedding, OfChunksComesCloseToThatOfTheWhole) {
  for (const auto function : {Function::kY, Function::kZ}) {
    const Mesh mesh = make_mesh(io::MeshKind::kScan, io::MeshOrder::kPatches, function);
    const auto whole = vertices_by_arc(embed(mesh, mesh.corners.size()));
    for (const std::size_t size : {300u, 4096u}) {
      const EmbeddedGraph sink = embed(mesh, size);
      expect_conserved(sink, mesh.positions);
      auto vertices = vertices_by_arc(sink);
      double astray = 0;
      for (const auto& [arc, count] : whole) astray += std::abs(std::exchange(vertices[arc], 0) - count);
      for (const auto& [arc, count] : vertices) astray += count;
      astray /= 2 * static_cast<double>(mesh.values.size());
      std::cout << "chunks of " << size << ": " << 100 * astray << " % on another arc\n";
      EXPECT_LT(astray, 0.05);
    }
  }
}

TEST(Embedding, IsTheSameEachTimeAndConservesWithNoiseRemoval) {
  for (const auto function : {Function::kZ, Function::kRandom})
    for (const auto kind : {io::MeshKind::kScan, io::MeshKind::kPlate}) {
      const Mesh mesh = make_mesh(kind, io::MeshOrder::kRows, function);
      for (const std::size_t size : {300u, 4096u, 1'000'000u}) {
        const EmbeddedGraph once = embed(mesh, size, 0.1);
        expect_conserved(once, mesh.positions);
        EXPECT_TRUE(once.arcs == embed(mesh, size, 0.1).arcs);
      }
    }
}

TEST(Embedding, GoesOnFromASavedState) {
  const Mesh mesh = make_mesh(io::MeshKind::kScan, io::MeshOrder::kPatches, Function::kZ);
  const auto options = [](double min, double max) {
    return SweepOptions{0.02 * (max - min), bucket_exponent(min, max, kBucketsOfMesh)};
  };
  EmbeddingSink without, with;
  const std::uint64_t removed = stream(mesh, 1000, without, options);
  const std::uint64_t removed_again = stream(mesh, 1000, with, options, [&](Glue& glue) {
    StateBytes state;
    glue.save(state);
    Glue next(with, true);
    next.restore(state);
    EXPECT_EQ(state.left(), 0u);
    glue = std::move(next);
  });
  EXPECT_EQ(removed, removed_again);
  EXPECT_TRUE(without.arcs == with.arcs);
}

}  // namespace
}  // namespace reeb::test
