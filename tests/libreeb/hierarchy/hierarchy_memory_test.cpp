// Building a hierarchy holds no more memory than hierarchy_bytes() says, and at most 170 bytes per arc.
#include <gtest/gtest.h>

#include "libreeb/hierarchy/cancel.h"
#include "ooc/threads/thread_turns.h"
#include "ooc/threads/worker.h"
#include "tests/support/held_memory.h"
#include "tests/support/inputs/made_graph.h"
#include "tests/support/inputs/random_function_graph.h"

namespace reeb {
namespace {

constexpr std::size_t kArcs = 100'000;

// A sink that discards the records.
class Nowhere : public RecordSink {
 public:
  void add(const ArcVersion&, std::span<const std::byte>) override { ++records_; }
  std::uint64_t records() const { return records_; }

 private:
  std::uint64_t records_ = 0;
};

DoBoth in_two_threads() {
  return [worker = std::make_shared<ooc::Worker>()](const auto& here, const auto& elsewhere) {
    worker->do_both(here, elsewhere);
  };
}

// `make` returns a graph, with buckets of this exponent or without.
template <class Make>
void expect_within_promise(Make make, int exponent, const DoBoth& both) {
  std::uint64_t promised = 0, records = 0;
  std::size_t arcs = 0;
  const std::size_t peak = test::peak_of([&] {
    auto [graph, buckets] = make();
    arcs = graph.arc_count();
    std::optional<std::uint64_t> lists;
    if (buckets.size() != 0) lists = buckets.memory_bytes();
    promised = hierarchy_bytes(graph.node_count(), arcs, lists);
    Nowhere nowhere;
    ooc::ThreadTurns turns;
    test::peak_bytes = test::held_bytes.load();  // memory for making the graph does not count
    const Hierarchy hierarchy =
        build_hierarchy(graph, std::move(buckets), exponent, nowhere, {.both = both, .turns = &turns});
    records = nowhere.records();
    ASSERT_GT(hierarchy.persistence.size(), arcs / 50);
  });
  EXPECT_GT(records, arcs);
  EXPECT_LE(peak, promised);
  EXPECT_GE(peak, promised / 2) << "a promise that keeps others waiting";
  EXPECT_LE(peak, 170 * arcs);
  std::printf("held %.1f bytes an arc of %.1f\n", static_cast<double>(peak) / static_cast<double>(arcs),
              static_cast<double>(promised) / static_cast<double>(arcs));
}

struct GraphAndLists {
  ReebGraph graph;
  PackedLists buckets;
};

class MadeGraphs : public testing::TestWithParam<std::tuple<bench::GraphKind, bool, bool>> {};
INSTANTIATE_TEST_SUITE_P(Kinds, MadeGraphs,
                         testing::Combine(testing::Values(bench::kPlate, bench::kNoise, bench::kExpander),
                                          testing::Bool(), testing::Bool()));

TEST_P(MadeGraphs, HoldNoMoreThanPromised) {
  const auto [kind, embeds, has_two_threads] = GetParam();
  int exponent = 0;
  ReebGraph made = bench::GraphMaker(kind, kArcs).make();
  bench::place_nodes(made);
  exponent = bucket_exponent(made.nodes.front().value, made.nodes.back().value, 64);
  expect_within_promise(
      [&] {
        return GraphAndLists{made, embeds ? pack_lists(bench::make_buckets(made, exponent).view()) : PackedLists{}};
      },
      exponent, has_two_threads ? in_two_threads() : DoBoth());
}

TEST(RandomFunction, HoldsNoMoreThanPromised) {
  const io::TempDir temp;
  MemoryBudget budget;
  int exponent = 0;
  expect_within_promise(
      [&] {
        ooc::LoadedGraph loaded = bench::make_random_function_graph(kArcs, 64, exponent, temp, budget);
        return GraphAndLists{std::move(loaded.graph), std::move(loaded.buckets)};
      },
      bucket_exponent(0, 1, 64), in_two_threads());
}

}  // namespace
}  // namespace reeb
