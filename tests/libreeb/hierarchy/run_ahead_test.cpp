// Cancelling with the rules ahead of the buckets and records: the same records, however far they run ahead, whichever
// thread is faster, and whenever what is left moves together.
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "libreeb/hierarchy/cancel.h"
#include "ooc/threads/thread_turns.h"
#include "ooc/threads/worker.h"
#include "tests/libreeb/hierarchy/random_buckets.h"
#include "tests/support/inputs/made_graph.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

struct Result {
  Hierarchy hierarchy;
  std::vector<ArcVersion> arcs;
  std::vector<std::vector<std::byte>> packed;
  std::vector<DroppedVertices> dropped;
  std::vector<std::thread::id> threads;
};

class Recorder : public RecordSink {
 public:
  // A slow one lets the other thread run whenever it can.
  Recorder(Result& result, bool slow) : result_(result), slow_(slow) {}
  void add(const ArcVersion& record, std::span<const std::byte> buckets) override {
    if (slow_) std::this_thread::yield();
    result_.arcs.push_back(record);
    result_.packed.emplace_back(buckets.begin(), buckets.end());
    result_.threads.push_back(std::this_thread::get_id());
  }
  void drop(const DroppedVertices& some) override { result_.dropped.push_back(some); }

 private:
  Result& result_;
  bool slow_;
};

constexpr std::size_t kNever = ~std::size_t{0};  // to shrink

// For the thread of the rules, the other one always is far behind.
class FarBehind : public ooc::ThreadTurns {
 public:
  std::size_t full() override { return std::max(ooc::ThreadTurns::full(), kSlots - 1); }
};

template <class Turns = ooc::ThreadTurns>
Result build(const test::EmbeddedGraph& made, const DoBoth& both, const RunAhead& ahead, bool slow = false,
             std::size_t shrink = kNever) {
  ReebGraph graph = made.graph;
  Result result;
  Recorder recorder(result, slow);
  Turns turns;
  result.hierarchy = build_hierarchy(graph, pack_lists(made.buckets.view()), made.exponent, recorder,
                                     {.both = both, .turns = &turns, .ahead = ahead, .shrink = shrink});
  return result;
}

void expect_same(const Result& a, const Result& b) {
  ASSERT_EQ(a.hierarchy.pairs, b.hierarchy.pairs);
  ASSERT_EQ(a.hierarchy.persistence, b.hierarchy.persistence);
  ASSERT_EQ(a.arcs, b.arcs);
  ASSERT_EQ(a.packed, b.packed);
  ASSERT_EQ(a.dropped, b.dropped);
}

// Long paths, many loops, and lists that change often.
test::EmbeddedGraph large_graph(bench::GraphKind kind, std::size_t arcs) {
  test::EmbeddedGraph made{.graph = bench::GraphMaker(kind, arcs).make(), .buckets = {}};
  bench::place_nodes(made.graph);
  made.exponent = bucket_exponent(made.graph.nodes.front().value, made.graph.nodes.back().value, 64);
  made.buckets = bench::make_buckets(made.graph, made.exponent);
  return made;
}

// From lists of one note, and every path read, to a list for all notes, and no path read.
const RunAhead kAhead[] = {{.notes = 1, .arcs_of_path = 0},    {.notes = 6, .arcs_of_path = 1},
                           {.notes = 40, .arcs_of_path = 2},   {.notes = 40, .arcs_of_path = 0},
                           {.notes = 8192, .arcs_of_path = 3}, {}};

// In turns with a fast and a slow sink.
void expect_same_in_two_threads(const test::EmbeddedGraph& made, ooc::Worker& worker, std::uint64_t seed) {
  const DoBoth both = [&](const auto& here, const auto& elsewhere) { worker.do_both(here, elsewhere); };
  const Result expected = build(made, {}, {});
  bool slow = seed % 2 == 0;
  for (const RunAhead& ahead : kAhead) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", notes " << ahead.notes);
    expect_same(build(made, both, ahead, slow = !slow), expected);
    expect_same(build<FarBehind>(made, both, ahead, slow), expected);
  }
}

class RunsAhead : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Nodes, RunsAhead, testing::Values(6, 12, 24));

TEST_P(RunsAhead, WithTheSameRecords) {
  ooc::Worker worker;
  for (std::uint64_t seed = 0; seed < test::case_count(20000 / GetParam()); ++seed) {
    test::Random random(seed);
    expect_same_in_two_threads(test::random_embedded_graph(random, GetParam()), worker, seed);
  }
}

// From the nodes and arcs moving together after each pair to rarely.
class Compacts : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Shrink, Compacts, testing::Values(1, 2, 4));

TEST_P(Compacts, WithTheSameRecords) {
  ooc::Worker worker;
  const DoBoth both = [&](const auto& here, const auto& elsewhere) { worker.do_both(here, elsewhere); };
  for (std::uint64_t seed = 0; seed < test::case_count(3000); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const test::EmbeddedGraph made =
        test::random_embedded_graph(random, static_cast<std::uint32_t>(seed % 50 == 0 ? 400 : 8 + seed % 24));
    const Result expected = build(made, {}, {});
    expect_same(build(made, {}, {}, false, GetParam()), expected);
    expect_same(build(made, both, kAhead[seed % std::size(kAhead)], seed % 2 == 0, GetParam()), expected);
  }
}

TEST_P(Compacts, LargeGraphsWithTheSameRecords) {
  for (const bench::GraphKind kind : {bench::kPlate, bench::kNoise, bench::kExpander}) {
    SCOPED_TRACE(testing::Message() << "kind " << static_cast<int>(kind));
    const test::EmbeddedGraph made = large_graph(kind, 2000);
    expect_same(build(made, {}, {}, false, GetParam()), build(made, {}, {}));
  }
}

// Pairs whose notes are in several lists change arcs that the pairs after them read.
TEST(RunAhead, WithTheSameRecordsForLargerGraphs) {
  ooc::Worker worker;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    test::Random random(seed);
    expect_same_in_two_threads(test::random_embedded_graph(random, 400), worker, seed);
  }
}

TEST(RunAhead, LargeGraphsInTwoThreads) {
  ooc::Worker worker;
  const DoBoth both = [&](const auto& here, const auto& elsewhere) { worker.do_both(here, elsewhere); };
  for (const bench::GraphKind kind : {bench::kPlate, bench::kNoise, bench::kExpander}) {
    SCOPED_TRACE(testing::Message() << "kind " << static_cast<int>(kind));
    const test::EmbeddedGraph made = large_graph(kind, 20000);
    const Result expected = build(made, {}, {});
    for (const RunAhead& ahead : kAhead) {
      SCOPED_TRACE(testing::Message() << "notes " << ahead.notes);
      const Result result = build(made, both, ahead);
      expect_same(result, expected);
      for (const std::thread::id thread : result.threads) ASSERT_EQ(thread, std::this_thread::get_id());
    }
  }
}

// A sink that fails, as a full disk does, while the other thread is at work: while it notes, waits for an empty list,
// waits to read an arc, or has ended.
TEST(RunAhead, AnErrorEndsBothThreads) {
  struct Full : RecordSink {
    void add(const ArcVersion&, std::span<const std::byte>) override {
      if (--left == 0) throw std::length_error("full");
    }
    std::uint64_t left = 0;
  };
  ooc::Worker worker;
  const DoBoth both = [&](const auto& here, const auto& elsewhere) { worker.do_both(here, elsewhere); };
  const test::EmbeddedGraph made = large_graph(bench::kPlate, 5000);
  const std::uint64_t records = build(made, {}, {}).arcs.size();
  for (const RunAhead& ahead : kAhead)
    for (std::uint64_t after = 1; after <= records; after += 1 + records / 20) {
      ReebGraph graph = made.graph;
      Full sink;
      sink.left = after;
      ooc::ThreadTurns turns;
      EXPECT_THROW(build_hierarchy(graph, pack_lists(made.buckets.view()), made.exponent, sink,
                                   {.both = both, .turns = &turns, .ahead = ahead}),
                   std::length_error);
      EXPECT_EQ(sink.left, 0u) << "notes " << ahead.notes;
    }
}

}  // namespace
}  // namespace reeb
