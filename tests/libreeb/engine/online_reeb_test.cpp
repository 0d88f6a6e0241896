// The on-line engine against the definition of the Reeb graph, on random complexes of every kind. REEB_SEED and
// REEB_CASES choose which complexes, and how many.
#include "libreeb/engine/online_reeb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>

#include "libreeb/base/error.h"
#include "tests/libreeb/engine/player.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/inputs/shapes.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

constexpr std::size_t kBatches[] = {1, 3, 7, 4096};

// Expects the same nodes and arcs, and the right positions where they are known.
testing::AssertionResult same_graph(const ReebGraph& graph, const ReebGraph& expected) {
  graph.validate();
  if (without_positions(graph) != without_positions(expected))
    return testing::AssertionFailure() << "got\n" << describe(graph) << "instead of\n" << describe(expected);
  if (!graph.positions.empty() && graph.positions != expected.positions)
    return testing::AssertionFailure() << "wrong positions";
  return testing::AssertionSuccess();
}

struct CollectingSink : GraphSink {
  void add_nodes(std::span<const SettledNode> more) override {
    for (const SettledNode& node : more) {
      nodes.push_back(node.key);
      positions.push_back(node.position);
    }
  }
  void add_arcs(const SettledArcs& more) override { arcs.insert(arcs.end(), more.arcs.begin(), more.arcs.end()); }

  std::vector<SweepKey> nodes;
  std::vector<Point> positions;
  std::vector<ArcKeys> arcs;
};

// Compares nodes one by one. A graph made of the arcs has parallel arcs only where the expected graph has.
void expect_written_once(const CollectingSink& sink, const ReebGraph& expected, const Complex& complex) {
  for (std::size_t i = 0; i < sink.nodes.size(); ++i) {
    if (sink.positions[i] == Point{}) continue;
    ASSERT_EQ(sink.positions[i], complex.positions[sink.nodes[i].vertex.value()]);
  }
  std::vector<SweepKey> nodes = sink.nodes;
  std::sort(nodes.begin(), nodes.end());
  ASSERT_EQ(nodes, expected.nodes);
  ASSERT_TRUE(same_graph(make_graph(sink.arcs, nodes), without_positions(expected)));
}

TEST(OnlineReeb, EqualsTheDefinitionOnRandomComplexes) {
  const std::uint64_t seed = base_seed(), cases = case_count(20'000);
  for (std::uint64_t i = 0; i < cases && !HasFatalFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    const ReebGraph expected = reference_reeb(complex);
    Random random(seed + i);
    for (const std::size_t batch : kBatches) {
      const Finalization finalization = any_finalization(random);
      OnlineReeb engine(any_waiting(batch, random));
      Player(complex, finalization, random.next()).play(engine);
      ASSERT_TRUE(same_graph(engine.snapshot(), expected))
          << "batches of " << batch << ", finalization " << static_cast<int>(finalization) << '\n'
          << describe(complex);
      if (random.chance(75)) continue;
      engine.finish();
      ASSERT_TRUE(same_graph(engine.snapshot(), expected)) << "finished, batches of " << batch << '\n'
                                                           << describe(complex);
    }
  }
}

TEST(OnlineReeb, IsExactAfterEverySingleInsertion) {
  const std::uint64_t seed = base_seed(), cases = case_count(600);
  for (std::uint64_t i = 0; i < cases && !HasFatalFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    if (complex.simplices.size() > 40) continue;
    Random random(seed + i);
    for (const std::size_t batch : kBatches) {
      OnlineReeb engine(any_waiting(batch, random));
      Player(complex, any_finalization(random), random.next())
          .play(engine, [&](std::size_t vertices, std::size_t simplices) {
            const ReebGraph expected = reference_reeb(beginning(complex, vertices, simplices));
            ASSERT_TRUE(same_graph(engine.snapshot(), expected))
                << "batches of " << batch << ", after simplex " << simplices << " and " << vertices << " vertices\n"
                << describe(complex);
          });
    }
  }
}

TEST(OnlineReeb, DoesNotDependOnTheOrderOfSimplices) {
  const std::uint64_t seed = base_seed(), cases = case_count(1500);
  for (std::uint64_t i = 0; i < cases && !HasFatalFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    OnlineReeb first;
    Player(complex, Finalization::kNever, 0).play(first);
    const ReebGraph expected = first.snapshot();
    Random random(seed + i);
    for (const std::size_t batch : kBatches) {
      const Complex other = shuffled(complex, random.next());
      OnlineReeb engine(any_waiting(batch, random));
      Player(other, any_finalization(random), random.next()).play(engine);
      ASSERT_TRUE(same_graph(engine.snapshot(), expected)) << "batches of " << batch << '\n' << describe(other);
    }
  }
}

TEST(OnlineReeb, HandsEverythingToTheSinkExactlyOnce) {
  const std::uint64_t seed = base_seed(), cases = case_count(3000);
  for (std::uint64_t i = 0; i < cases && !HasFatalFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    SCOPED_TRACE(describe(complex));
    const ReebGraph expected = reference_reeb(complex);
    Random random(seed + i);
    for (const std::size_t batch : kBatches) {
      SCOPED_TRACE(batch);
      CollectingSink sink;
      OnlineReeb engine(any_waiting(batch, random), &sink);
      Player(complex, any_finalization(random), random.next()).play(engine);
      engine.finish();
      expect_written_once(sink, expected, complex);
    }
  }
}

TEST(OnlineReeb, HandsOverWhatIsFinalBeforeTheEnd) {
  CollectingSink sink;
  OnlineReeb engine({.batch_triangles = 16}, &sink);
  // 400 separate edges, each final at once.
  for (std::uint64_t v = 0; v < 800; ++v) {
    engine.add_vertex(static_cast<double>(v));
    if (v % 2 == 0) continue;
    engine.add_simplex(std::vector{VertexId(v - 1), VertexId(v)});
    engine.finalize(VertexId(v - 1));
    engine.finalize(VertexId(v));
  }
  const std::size_t before = sink.arcs.size();
  EXPECT_GE(before, 300u) << "what can no longer change was kept";
  EXPECT_EQ(engine.snapshot().arc_count() + sink.arcs.size(), 400u);
  engine.finish();
  EXPECT_EQ(sink.arcs.size(), 400u);
}

// Shapes on which a careless engine is quadratic; their graphs are known.
class LargeShapes : public testing::TestWithParam<std::size_t> {
 protected:
  // Where triangles are glued batch by batch, and where they wait.
  static ReebGraph graph_of(const Complex& complex, Finalization finalization) {
    OnlineReeb engine({.batch_triangles = GetParam(), .waiting_triangles = 0}),
        waiting({.batch_triangles = GetParam()});
    Player(complex, finalization, 1).play(engine);
    Player(complex, finalization, 1).play(waiting);
    EXPECT_EQ(waiting.snapshot(), engine.snapshot());
    return without_positions(engine.snapshot());
  }
  static ReebGraph arc(std::uint64_t lo, std::uint64_t hi, const Complex& complex) {
    return make_graph({{{complex.values[lo], VertexId(lo)}, {complex.values[hi], VertexId(hi)}}}, {});
  }
};

TEST_P(LargeShapes, AFanIsOneArc) {
  for (const bool closed : {false, true}) {
    const Complex complex = fan(2000, closed);
    const ReebGraph expected = arc(0, complex.vertex_count() - 1, complex);
    EXPECT_TRUE(same_graph(graph_of(complex, Finalization::kNever), expected));
    EXPECT_TRUE(same_graph(graph_of(shuffled(complex, 1), Finalization::kNever), expected));
  }
}

TEST_P(LargeShapes, ABookBranchesAtItsSpine) {
  const Complex complex = book(2000);
  std::vector<ArcKeys> arcs{{{0, VertexId(0)}, {0, VertexId(1)}}};
  for (std::uint64_t page = 2; page < complex.vertex_count(); ++page)
    arcs.push_back({{0, VertexId(1)}, {0, VertexId(page)}});
  EXPECT_TRUE(same_graph(graph_of(complex, Finalization::kNever), make_graph(arcs, {})));
}

TEST_P(LargeShapes, APlateauIsOneArc) {
  const Complex complex = plateau(40, 40);
  EXPECT_TRUE(same_graph(graph_of(complex, Finalization::kLater), arc(0, complex.vertex_count() - 1, complex)));
}

TEST_P(LargeShapes, AStripSweptAlongTheStreamIsOneArc) {
  const Complex complex = tied_strip(500, 6);
  const ReebGraph expected = arc(0, complex.vertex_count() - 1, complex);
  EXPECT_TRUE(same_graph(graph_of(complex, Finalization::kNever), expected));
  EXPECT_TRUE(same_graph(graph_of(complex, Finalization::kLater), expected));
}

TEST_P(LargeShapes, AnUprightTorusHasItsLoop) {
  const Complex complex = upright_torus(60, 30);
  const ReebGraph graph = graph_of(complex, Finalization::kLater);
  EXPECT_EQ(betti_numbers(graph).loops, 1u);
  EXPECT_EQ(betti_numbers(graph).components, 1u);
  EXPECT_EQ(graph.arc_count(), 4u);
}

INSTANTIATE_TEST_SUITE_P(Batches, LargeShapes, testing::ValuesIn(kBatches), testing::PrintToStringParamName());

TEST(OnlineReeb, GoesOnAfterBeingMoved) {
  OnlineReeb first;
  first.add_vertex(1);
  first.add_vertex(2);
  OnlineReeb second = std::move(first);
  second.add_simplex(std::vector{VertexId(0), VertexId(1)});
  first = std::move(second);
  EXPECT_EQ(first.snapshot().arc_count(), 1u);
}

void expect_bad_input(const std::function<void()>& call) {
  try {
    call();
    ADD_FAILURE() << "the call was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_FALSE(error.message().empty());
    EXPECT_FALSE(error.hint().empty());
  }
}

TEST(OnlineReebMisuse, IsRefusedAndLeavesTheGraphAlone) {
  for (const std::size_t batch : kBatches) {
    OnlineReeb engine({.batch_triangles = batch});
    for (const double value : {0.0, 1.0, 2.0, 3.0}) engine.add_vertex(value);
    engine.add_simplex(std::vector{VertexId(0), VertexId(1), VertexId(2)});
    engine.finalize(VertexId(1));
    const ReebGraph before = engine.snapshot();

    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity})
      for (const Point& position : {Point{}, Point{0, value, 0}})
        expect_bad_input([&] { engine.add_vertex(position == Point{} ? value : 4, position); });
    expect_bad_input([&] { engine.add_simplex(std::vector{VertexId(2), VertexId(4)}); });
    expect_bad_input([&] { engine.add_simplex(std::vector{VertexId(~std::uint64_t{0})}); });
    expect_bad_input([&] { engine.add_simplex(std::vector{VertexId(2), VertexId(3), VertexId(1)}); });
    expect_bad_input([&] { engine.finalize(VertexId(1)); });
    expect_bad_input([&] { engine.finalize(VertexId(4)); });

    EXPECT_EQ(engine.snapshot(), before);
    EXPECT_EQ(engine.add_vertex(4), VertexId(4)) << "a refused vertex took a number";
  }
}

TEST(OnlineReebMisuse, BadOptionsAreRefused) {
  for (const double noise : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(OnlineReeb({.noise_below = noise}), Error);
  EXPECT_THROW(OnlineReeb({.buckets = (1u << 20) + 1}), Error);
  EXPECT_NO_THROW(OnlineReeb({.buckets = 1u << 20}));
}

TEST(OnlineReebMisuse, NothingIsAddedAfterFinish) {
  OnlineReeb engine;
  const VertexId a = engine.add_vertex(0), b = engine.add_vertex(1);
  engine.add_simplex(std::vector{a, b});
  engine.finish();
  const ReebGraph graph = engine.snapshot();
  EXPECT_EQ(graph.arc_count(), 1u);

  expect_bad_input([&] { engine.add_vertex(2); });
  expect_bad_input([&] { engine.add_simplex(std::vector{a, b}); });
  expect_bad_input([&] { engine.finalize(a); });
  engine.finish();
  EXPECT_EQ(engine.snapshot(), graph);
}

}  // namespace
}  // namespace reeb::test
