// The last pass on a stored graph is compared with noise removal on the whole graph in memory: the same nodes, arcs and
// buckets, to the bit, however the graph is stored and read.
#include "ooc/stored_graph/last_noise_pass.h"
#include "ooc/stored_graph/load_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "libreeb/graph/packed_buckets.h"
#include "libreeb/noise/denoise.h"
#include "ooc/stored_graph/noise_places.h"
#include "tests/libreeb/hierarchy/random_buckets.h"
#include "tests/support/scratch.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

using test::EmbeddedGraph;
using test::Random;

// A random order, except that parallel arcs stay in the graph's own order.
std::vector<std::size_t> order_of_adding(const ReebGraph& graph, Random& random) {
  std::vector<std::size_t> order(graph.arc_count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  const auto ends = [&](std::size_t arc) { return std::pair(graph.lo[arc], graph.hi[arc]); };
  std::vector<std::size_t> places(order.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_sort(places.begin(), places.end(), [&](auto a, auto b) { return ends(order[a]) < ends(order[b]); });
  for (std::size_t arc = 0; arc < places.size(); ++arc) order[places[arc]] = arc;
  return order;
}

void add(SegmentStore& store, const EmbeddedGraph& made, bool embeds, Random& random) {
  const ReebGraph& graph = made.graph;
  std::vector<SettledNode> nodes;
  for (std::size_t i = 0; i < graph.node_count(); ++i) nodes.push_back({graph.nodes[i], graph.positions[i]});
  std::shuffle(nodes.begin(), nodes.end(), random);
  store.add_nodes(nodes);
  for (const std::size_t arc : order_of_adding(graph, random)) {
    const ArcKeys keys{graph.nodes[graph.lo[arc].value()], graph.nodes[graph.hi[arc].value()]};
    ArcLists lists;
    if (embeds) lists.add(made.buckets.view().of(arc));
    store.add_arcs({std::span(&keys, 1), lists.view(), made.exponent});
  }
}

// One more than the largest vertex.
std::uint64_t vertices_of(const ReebGraph& graph) {
  std::uint64_t count = 0;
  for (const SweepKey& node : graph.nodes) count = std::max(count, node.vertex.value() + 1);
  return count;
}

// Reads all arcs, at most `limit` at a time, and compares.
void expect_arcs(SegmentStore& store, std::size_t limit, std::optional<int> exponent, const ReebGraph& graph,
                 const ArcBuckets& buckets) {
  store.rewind_arcs();
  std::size_t arc = 0;
  for (ArcPiece piece; store.read_arcs(piece, limit, exponent);) {
    ASSERT_LE(piece.arcs.size(), limit);
    for (std::size_t i = 0; i < piece.arcs.size(); ++i, ++arc) {
      ASSERT_LT(arc, graph.arc_count());
      const ArcKeys expected{graph.nodes[graph.lo[arc].value()], graph.nodes[graph.hi[arc].value()]};
      ASSERT_EQ(piece.arcs[i], expected);
      if (!exponent) continue;
      std::vector<Bucket> own;
      piece.lists.view().unpack(i, own);
      ASSERT_TRUE(std::ranges::equal(own, buckets.view().of(arc))) << "arc " << arc;
    }
  }
  ASSERT_EQ(arc, graph.arc_count());
}

struct Stored {
  Scratch scratch;
  io::TempDir temp{scratch.path()};
  MemoryBudget budget;
  SegmentStore store;

  Stored(const EmbeddedGraph& made, bool embeds, Random& random, std::uint64_t budget_bytes = MemoryBudget::kUnlimited)
      : budget(budget_bytes), store(temp, budget, {.allowance_bytes = 0, .background = false}) {
    add(store, made, embeds, random);
    store.finish();
  }
};

ArcBuckets unpacked(const PackedLists& lists) {
  ArcBuckets all;
  all.offsets.push_back(0);
  for (std::size_t arc = 0; arc < lists.size(); ++arc) {
    EXPECT_TRUE(unpack_buckets(lists.of(arc), all.buckets));
    all.offsets.push_back(all.buckets.size());
  }
  return all;
}

std::uint64_t check(const EmbeddedGraph& made, double threshold, bool embeds, Random& random) {
  Stored stored(made, embeds, random);
  SegmentStore& store = stored.store;
  const std::uint64_t part_bytes = test::below(random, 2) == 0 ? 0 : 4 << 20;
  // Collected in memory, or on disk: if arcs have buckets, each in a run of its own.
  const std::uint64_t change_bytes = test::below(random, 2) == 0 ? 0 : 1 << 20;
  const std::uint64_t vertices = test::below(random, 2) == 0 ? 0 : vertices_of(made.graph);
  const std::optional<int> exponent = embeds ? std::optional(made.exponent) : std::nullopt;
  ArcBuckets buckets = embeds ? made.buckets : ArcBuckets();
  const Denoised expected = denoise(made.graph, threshold, buckets, made.exponent);

  LastNoisePass pass =
      run_last_noise_pass(store, stored.temp, {threshold, exponent, vertices, part_bytes, change_bytes});
  EXPECT_TRUE(pass.fits);
  EXPECT_EQ(pass.removed_pairs, expected.removed.size());
  EXPECT_EQ(pass.change.has_value(), pass.removed_pairs != 0);
  if (pass.change) store.apply(std::move(*pass.change));
  EXPECT_EQ(store.node_count(), expected.graph.node_count());
  EXPECT_EQ(store.arc_count(), expected.graph.arc_count());
  const LoadedGraph loaded = read_graph(store, {.bucket_exponent = exponent});
  EXPECT_EQ(loaded.graph, expected.graph);
  const ArcBuckets loaded_buckets = embeds ? unpacked(loaded.buckets) : ArcBuckets();
  EXPECT_EQ(loaded_buckets.offsets, buckets.offsets);
  EXPECT_EQ(loaded_buckets.buckets, buckets.buckets);
  EXPECT_LE(loaded_buckets.buckets.size(), store.bucket_count());
  for (const std::size_t limit : {std::size_t{1}, std::size_t{3}})
    expect_arcs(store, limit, exponent, expected.graph, buckets);
  return pass.removed_pairs;
}

TEST(LastNoisePass, LeavesWhatNoiseRemovalInMemoryDoes) {
  const std::uint64_t seed = test::base_seed(), cases = test::case_count(3000);
  std::uint64_t removed = 0;
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", case " << i);
    Random random(seed + i);
    const std::uint32_t nodes = i % 4 == 0 ? 120 : 14;
    const EmbeddedGraph made = test::random_embedded_graph(random, nodes);
    // From no arc to nearly all; the values of graphs with n nodes are within 3n.
    const double threshold = static_cast<double>(test::below(random, i % 3 == 0 ? 6 : 2 * nodes));
    removed += check(made, threshold, i % 2 == 0, random);
  }
  EXPECT_GT(removed, cases / 2);
}

// A bucket for each arc.
EmbeddedGraph embedded(std::vector<ArcKeys> arcs) {
  EmbeddedGraph made{test::contracted(std::move(arcs), {}), {.offsets = {0}, .buckets = {}}, 1};
  for (const SweepKey& key : made.graph.nodes) made.graph.positions.push_back({key.value, 1, 2});
  for (std::size_t arc = 0; arc < made.graph.arc_count(); ++arc) {
    const double value = made.graph.nodes[made.graph.lo[arc].value()].value;
    made.buckets.buckets.push_back({bucket_index(value, 1), 1 + arc % 5, {value, 3, static_cast<double>(arc)}});
    made.buckets.offsets.push_back(arc + 1);
  }
  return made;
}

// A trunk of small loops with twigs that have twigs: few of many short arcs can be removed.
EmbeddedGraph trunk(std::uint32_t segments, Random& random) {
  std::vector<ArcKeys> arcs;
  std::uint64_t next = 0;
  const auto node = [&](double value) { return SweepKey{value, VertexId(next++)}; };
  SweepKey from = node(0);
  for (std::uint32_t i = 1; i <= segments; ++i) {
    const SweepKey fork = node(10.0 * i), join = node(10.0 * i + 1 + test::below(random, 9));
    arcs.insert(arcs.end(), {{from, fork}, {fork, join}, {fork, join}});
    from = join;
    SweepKey at = join;
    while (test::below(random, 3) == 0) {
      const bool up = test::below(random, 2) == 0;
      const double reach = 1 + test::below(random, 40);
      const SweepKey tip = node(up ? at.value + reach : at.value - reach);
      arcs.push_back({std::min(at, tip), std::max(at, tip)});
      if (test::below(random, 2) == 0) at = tip;
    }
  }
  arcs.push_back({from, node(10.0 * segments + 100)});
  return embedded(std::move(arcs));
}

TEST(LastNoisePass, FindsTheTwigsOfATrunk) {
  const std::uint64_t seed = test::base_seed();
  for (std::uint64_t i = 0; i < 300 && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", case " << i);
    Random random(seed + i);
    const EmbeddedGraph made = trunk(30, random);
    check(made, static_cast<double>(test::below(random, 45)), i % 2 == 0, random);
  }
}

// Four ways from 0 to 1000 become arcs when their twigs are removed, next to two that are arcs already. In each pair of
// ways the lower one has its twigs above those of the other, or below, so no order of parts is the order of the arcs.
TEST(LastNoisePass, ParallelArcsKeepTheOrderOfTheirLowestParts) {
  const auto arc = [](double lo, double hi) {
    const auto key = [](double value) { return SweepKey{value, VertexId(static_cast<std::uint64_t>(value))}; };
    return ArcKeys{key(lo), key(hi)};
  };
  std::vector<ArcKeys> arcs{arc(0, 1000), arc(0, 1000)};
  for (const double fork : {380, 385, 400, 410}) arcs.insert(arcs.end(), {arc(0, fork), arc(fork, 1000)});
  arcs.insert(arcs.end(), {arc(380, 391), arc(385, 386), arc(400, 401), arc(410, 411), arc(399, 410)});
  const EmbeddedGraph made = embedded(std::move(arcs));
  Random random(5);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(check(made, 12, true, random), 5u);
}

TEST(LastNoisePass, OfAGraphOnDiskInManyRuns) {
  Random random(7);
  const EmbeddedGraph made = trunk(700, random);
  ASSERT_GT(made.graph.arc_count(), 2000u);
  for (const bool embeds : {false, true}) {
    ASSERT_GT(Stored(made, embeds, random).store.spilled_bytes(), 0u);
    EXPECT_GT(check(made, 30, embeds, random), 100u);
  }
}

TEST(LastNoisePass, HoldsWhatNoiseCanTouchAndNotTheGraph) {
  Random random(3);
  EmbeddedGraph made = trunk(700, random);
  Stored stored(made, true, random);
  // A twig of 1 can be removed; the loops of 9 all around it stay as they are.
  const LastNoisePass pass = run_last_noise_pass(stored.store, stored.temp, {10, made.exponent});
  ASSERT_TRUE(pass.change);
  const std::size_t touched = pass.change->replaced_arcs;
  EXPECT_LT(touched, 8 * pass.removed_pairs);
  EXPECT_LT(touched, made.graph.arc_count() / 2);
}

TEST(LastNoisePass, ArcsOfALargeChangeAreOnDisk) {
  Random random(13);
  const EmbeddedGraph made = trunk(700, random);
  Stored stored(made, true, random);
  const auto arcs_with = [&](std::uint64_t change_bytes) {
    LastNoisePass pass = run_last_noise_pass(
        stored.store, stored.temp, {.threshold = 30, .bucket_exponent = made.exponent, .change_bytes = change_bytes});
    return std::move(pass.change->arcs);
  };
  const auto in_memory = arcs_with(1 << 20), on_disk = arcs_with(64 << 10);
  EXPECT_EQ(in_memory->spilled_bytes(), 0u);
  EXPECT_GT(on_disk->spilled_bytes(), 0u);
  EXPECT_EQ(on_disk->size(), in_memory->size());
}

TEST(LastNoisePass, WhatItSaysThatItNeedsIsEnough) {
  constexpr std::uint64_t kBudget = 64 << 20;
  Random random(11);
  const EmbeddedGraph made = trunk(700, random);
  Stored stored(made, true, random, kBudget);
  MemoryBudget& budget = stored.budget;
  const std::uint64_t used = budget.used_bytes();
  const auto pass_with = [&](std::uint64_t room) {
    const Reservation others = budget.reserve("others", budget.free_bytes() - room);
    return run_last_noise_pass(stored.store, stored.temp, {30, made.exponent, vertices_of(made.graph)});
  };
  std::size_t refusals = 0;
  for (std::uint64_t room = 1024; room < kBudget / 2; room += room / 4) {
    const LastNoisePass pass = pass_with(room);
    if (pass.fits) {
      EXPECT_GT(pass.removed_pairs, 100u);
      EXPECT_GT(refusals, 10u);
      return;
    }
    ++refusals;
    ASSERT_FALSE(pass.change);
    ASSERT_EQ(budget.used_bytes(), used);
    ASSERT_GT(pass.needed_bytes, room);
    ASSERT_TRUE(pass_with(pass.needed_bytes).fits) << pass.needed_bytes << " with " << room;
  }
  FAIL() << "never had room";
}

// The nodes stay until the end of the pass, beside the largest part. Memory that is no longer needed must be free then.
TEST(NoisePlaces, KeepingTheNodesFreesTheRest) {
  NoisePlaces places{.nodes = std::vector<SweepKey>(3), .arcs = {1, 2, 3}, .bucket_bytes = {1, 2, 3}};
  places.keep_nodes();
  EXPECT_EQ(places.size(), 3u);
  EXPECT_EQ(places.arcs.capacity(), 0u);
  EXPECT_EQ(places.bucket_bytes.capacity(), 0u);
}

}  // namespace
}  // namespace reeb::ooc
