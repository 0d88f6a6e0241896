// On-line noise removal against the definition: the run and the last pass together remove the same leaves as removal
// from the exact graph, whatever the stream (docs/SEMANTICS.md, Noise removal).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "libreeb/engine/live_graph.h"
#include "libreeb/noise/denoise.h"
#include "tests/libreeb/engine/player.h"
#include "tests/libreeb/engine/streamed_mesh.h"
#include "tests/model/naive_denoise.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

constexpr std::size_t kBatches[] = {1, 3, 7, 4096};

// A threshold that is the difference of two values, or almost, so that ties matter.
double random_threshold(const Complex& complex, Random& random) {
  if (complex.values.empty()) return 1;
  const auto any = [&] { return complex.values[random.below(complex.values.size())]; };
  const double difference = std::abs(any() / 2 - any() / 2);
  switch (random.below(4)) {
    case 0:
      return difference;
    case 1:
      return std::numeric_limits<double>::infinity();
    default:
      return 2 * difference;
  }
}

class OnlineNoise : public testing::Test {
 protected:
  // Compares a graph from which `online` pairs were removed with the exact graph after noise removal.
  void expect_same_in_the_end(const ReebGraph& graph, std::uint64_t online, const ReebGraph& exact, double threshold) {
    ASSERT_NO_THROW(graph.validate());
    const reeb::Denoised rest = reeb::denoise(graph, threshold);
    const reeb::Denoised all = reeb::denoise(exact, threshold);
    ASSERT_EQ(without_positions(rest.graph), without_positions(all.graph)) << "got\n"
                                                                           << describe(graph) << "from\n"
                                                                           << describe(exact);
    ASSERT_EQ(online + rest.removed.size(), all.removed.size());
    online_ += online;
    all_ += all.removed.size();
  }

  void check_case(std::uint64_t seed);

  std::uint64_t online_ = 0, all_ = 0;
};

void OnlineNoise::check_case(std::uint64_t seed) {
  const Complex complex = random_complex(seed);
  const ReebGraph exact = reference_reeb(complex);
  Random random(seed);
  const double threshold = random_threshold(complex, random);
  SCOPED_TRACE(testing::Message() << "threshold " << threshold << ", " << describe(complex));
  if (exact.node_count() < 30) {
    const Denoised naive = naive_denoise(exact, threshold, random.next());
    ASSERT_EQ(without_positions(naive.graph), without_positions(reeb::denoise(exact, threshold).graph));
  }
  for (const std::size_t batch : kBatches) {
    SCOPED_TRACE(batch);
    OnlineReeb::Options options = any_waiting(batch, random);
    options.noise_below = threshold;
    OnlineReeb engine(options);
    Player(complex, any_finalization(random), random.next()).play(engine);
    const ReebGraph snapshot = engine.snapshot();
    expect_same_in_the_end(snapshot, engine.removed_pairs(), exact, threshold);
    engine.finish();
    const ReebGraph finished = engine.snapshot();
    expect_same_in_the_end(finished, engine.removed_pairs(), exact, threshold);
  }
}

TEST_F(OnlineNoise, TogetherWithTheLastPassEqualsTheDefinition) {
  const std::uint64_t seed = base_seed(), cases = case_count(20'000);
  for (std::uint64_t i = 0; i < cases && !HasFatalFailure(); ++i) check_case(seed + i);
  std::cout << online_ << " of " << all_ << " pairs were removed on the way\n";
  EXPECT_GT(all_, cases / 10);
  EXPECT_GT(online_, all_ / 2) << "hardly anything is removed on the way";
}

// A settled saddle loses a leaf. Before it is contracted, another of its arcs would be written out: the node at the
// other end of that arc is examined first, and settles.
//
//   w 30       |
//   t 20      / \            u is 19.5, so its arc is noise from the start: t does not settle while paths pass it.
//   saddle   u   |
//   10          / \          The leaf is 11.5, so its arc is noise only under the second threshold.
//   x 0        |   leaf
TEST_F(OnlineNoise, ASettledSaddleDisappearsWithItsLeaf) {
  using State = LiveGraph::State;
  KeepingSink sink;
  LiveGraph live(sink, false);
  live.set_options({.noise_below = 0.6});
  const auto add_node = [&](std::uint64_t vertex, double value, State state) {
    return live.add_node({value, VertexId(vertex)}, {}, state);
  };
  const auto x = add_node(0, 0, State::kIncomplete), saddle = add_node(1, 10, State::kComplete),
             leaf = add_node(2, 11.5, State::kIncomplete), u = add_node(3, 19.5, State::kIncomplete),
             t = add_node(4, 20, State::kComplete), w = add_node(5, 30, State::kIncomplete);
  const auto to_saddle = live.add_arc(x, saddle), to_leaf = live.add_arc(saddle, leaf), to_t = live.add_arc(saddle, t),
             from_u = live.add_arc(u, t), to_w = live.add_arc(t, w);
  const auto from_leaf = live.add_reference(to_leaf, live.add_reference(to_saddle, LiveGraph::kNone));
  const auto from_w = live.add_reference(to_w, live.add_reference(from_u, LiveGraph::kNone));
  for (const auto arc : {to_saddle, to_leaf, to_t, from_u, to_w}) live.release(arc);
  live.tidy();
  ASSERT_EQ(live.state(saddle), State::kSettled);
  ASSERT_EQ(live.state(t), State::kComplete);

  live.set_options({.noise_below = 2});
  live.drop_path(from_leaf);
  live.drop_path(from_w);
  live.complete(leaf);
  live.tidy();
  live.validate();
  for (const auto node : {u, w, x}) {
    live.complete(node);
    live.tidy();
  }
  live.flush();
  EXPECT_EQ(live.removed_pairs(), 2u);
  EXPECT_EQ(sink.nodes, (std::vector<SweepKey>{{0, VertexId(0)}, {30, VertexId(5)}}));
  EXPECT_EQ(sink.arcs, (std::vector<ArcKeys>{{{0, VertexId(0)}, {30, VertexId(5)}}}));
}

// Chunks with long paths through many splits, and a threshold that grows along the stream.
TEST_F(OnlineNoise, AShareOfTheRangeSoFarLeadsToTheSameEnd) {
  for (const auto kind : {io::MeshKind::kScan, io::MeshKind::kGrid})
    for (const auto function : {Function::kY, Function::kZ, Function::kRandom})
      for (const double share : {0.001, 0.05, 0.6}) {
        const Mesh mesh = make_mesh(kind, io::MeshOrder::kPatches, function);
        KeepingSink exact;
        stream(mesh, mesh.corners.size(), exact, [](double, double) { return SweepOptions{}; });
        const auto [min, max] = std::minmax_element(mesh.values.begin(), mesh.values.end());
        for (const std::size_t size : {300u, 4096u, 1'000'000u}) {
          SCOPED_TRACE(testing::Message()
                       << "kind " << static_cast<int>(kind) << ", function " << static_cast<int>(function) << ", share "
                       << share << ", chunks of " << size);
          KeepingSink sink;
          const std::uint64_t online = stream(mesh, size, sink, [&](double least, double most) {
            return SweepOptions{.noise_below = share * (most - least)};
          });
          expect_same_in_the_end(sink.graph(), online, exact.graph(), share * (*max - *min));
        }
      }
  std::cout << online_ << " of " << all_ << " pairs were removed on the way\n";
  EXPECT_GT(online_, all_ / 4 * 3) << "much is left for the last pass";
}

// Arcs of a random function that are short because nodes are many, not because they lead to a leaf nearby, keep no node
// waiting.
TEST_F(OnlineNoise, ARandomFunctionKeepsHardlyMoreArcsForIt) {
  const Mesh mesh = make_mesh(io::MeshKind::kScan, io::MeshOrder::kPatches, Function::kRandom);
  const auto most_arcs = [&](double share) {
    KeepingSink sink;
    std::size_t most = 0;
    stream(
        mesh, 2000, sink,
        [&](double least, double highest) { return SweepOptions{.noise_below = share * (highest - least)}; },
        [&](Glue& glue) { most = std::max(most, glue.graph().arc_count()); });
    return most;
  };
  const std::size_t without = most_arcs(0), with = most_arcs(0.005);
  std::cout << "at most " << without << " arcs, " << with << " with noise removal\n";
  EXPECT_LT(with, without + without / 20);
}

}  // namespace
}  // namespace reeb::test
