// A hierarchy that is made on disk has the bytes of the one that is made in memory, whatever memory there is; or it
// says that the graph has no locality.
#include "ooc/stored_hierarchy/stored_hierarchy.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>

#include "libreeb/base/error.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/hierarchy/cancel.h"
#include "ooc/reeb_writer/record_log.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/support/files.h"
#include "tests/support/inputs/made_graph.h"
#include "tests/support/inputs/random_graph.h"
#include "tests/support/scratch.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kMuch = 1 << 30;

struct Given {
  ReebGraph graph;
  ArcBuckets buckets;  // without offsets if there is no embedding
  int exponent = 0;

  std::optional<int> bucket_exponent() const {
    return buckets.offsets.empty() ? std::nullopt : std::optional(exponent);
  }
};

Given with_positions(ReebGraph graph, bool embeds) {
  Given given{std::move(graph), {}, 0};
  given.graph.positions.clear();
  bench::place_nodes(given.graph);
  if (!embeds || given.graph.arc_count() == 0) return given;
  given.exponent = reeb::bucket_exponent(given.graph.nodes.front().value, given.graph.nodes.back().value, 64);
  given.buckets = bench::make_buckets(given.graph, given.exponent);
  return given;
}

// Takes them, and writes nothing.
class NoRecords : public RecordSink {
 public:
  void add(const ArcVersion& /*record*/, std::span<const std::byte> /*buckets*/) override {}
};

class StoredHierarchyTest : public testing::Test {
 protected:
  void fill(const Given& given, SegmentStore& store) const {
    const ReebGraph& graph = given.graph;
    for (std::size_t node = 0; node < graph.node_count(); ++node)
      store.add_nodes(std::array{SettledNode{graph.nodes[node], graph.positions[node]}});
    for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
      const std::array keys{ArcKeys{graph.nodes[graph.lo[arc].value()], graph.nodes[graph.hi[arc].value()]}};
      ArcLists lists;
      if (given.bucket_exponent()) lists.add(given.buckets.view().of(arc));
      store.add_arcs({keys, lists.view(), given.exponent});
    }
    store.finish();
  }

  std::string made_in_memory(const Given& given) {
    MemoryBudget budget;
    ReebGraph graph = given.graph;
    RecordLog records(temp_, budget);
    const Hierarchy hierarchy = build_hierarchy(graph, pack_lists(given.buckets.view()), given.exponent, records);
    HierarchyInMemory source(graph, hierarchy);
    return written(given, source, records);
  }

  // Empty if the graph has no locality.
  std::string made_on_disk(const Given& given, std::uint64_t bytes, const Poll& poll = {},
                           std::uint64_t most_pages = kMuch) {
    MemoryBudget much, budget(bytes);
    SegmentStore store(temp_, much);
    fill(given, store);
    RecordLog records(temp_, much);
    StoredHierarchy hierarchy(
        store, temp_, budget,
        {.bucket_exponent = given.bucket_exponent(), .background = false, .most_pages = most_pages});
    hierarchy.pair_nodes(poll);
    const bool done = hierarchy.cancel(records, poll);
    pages_read_again_ = hierarchy.refetches();
    spilled_ = hierarchy.spilled_bytes();
    return done ? written(given, hierarchy, records) : std::string();
  }

  static std::uint64_t least_bytes(const Given& given) {
    return StoredHierarchy::least_bytes(given.graph.node_count());
  }

  void expect_same(const Given& given, std::uint64_t bytes) {
    const bool same = made_in_memory(given) == made_on_disk(given, bytes);
    ASSERT_TRUE(same) << bytes << " bytes of memory";
  }

  // Every third file is written in one thread, the others in two: so some in memory and some on disk in either way.
  std::string written(const Given& given, HierarchySource& source, RecordLog& records) {
    const bool background = files_++ % 3 != 0;
    const std::string path = folder_.path() + "/out.reeb";
    FileMeta meta;
    meta.bucket_exponent = given.exponent;
    if (!given.graph.nodes.empty()) {
      meta.function_min = given.graph.nodes.front().value;
      meta.function_max = given.graph.nodes.back().value;
    }
    write_hierarchy_file(path, meta,
                         {source, records, given.bucket_exponent().has_value(), background, {io::Existing::kReplace}});
    return test::read_file(path);
  }

  const Scratch folder_;
  const io::TempDir temp_{folder_.path()};
  std::uint64_t pages_read_again_ = 0, spilled_ = 0, files_ = 0;
};

TEST_F(StoredHierarchyTest, SmallGraphs) {
  const std::uint64_t base = test::base_seed();
  for (std::uint64_t i = 0; i < test::case_count(100) && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    const Given given = with_positions(test::random_graph(base + i), i % 2 == 0);
    expect_same(given, least_bytes(given));
  }
}

TEST_F(StoredHierarchyTest, GraphsWithManyLoops) {
  const std::uint64_t base = test::base_seed();
  for (std::uint64_t i = 0; i < test::case_count(20) && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    const Given given = with_positions(test::random_graph(base + i, 300 + 40 * i), i % 2 == 0);
    expect_same(given, least_bytes(given));
  }
}

TEST_F(StoredHierarchyTest, EmptyGraph) { expect_same({}, least_bytes({})); }

TEST_F(StoredHierarchyTest, LargeGraphsWithLittleMemoryReadPagesAgain) {
  for (const bool embeds : {false, true}) {
    const Given given = with_positions(bench::GraphMaker(bench::kNoise, 80'000).make(), embeds);
    ASSERT_NO_FATAL_FAILURE(expect_same(given, least_bytes(given)));
    EXPECT_GT(pages_read_again_, 1000u);
  }
}

// Pages are written one by one, and all else in larger pieces.
TEST_F(StoredHierarchyTest, AllThatIsWrittenCountsAsSpilled) {
  for (const bool embeds : {false, true}) {
    const Given given = with_positions(bench::GraphMaker(bench::kNoise, 20'000).make(), embeds);
    std::vector<std::byte> lists;
    for (std::size_t arc = 0; embeds && arc < given.graph.arc_count(); ++arc)
      pack_buckets(given.buckets.view().of(arc), lists);
    const FaultAtCall writes(io::FileCall::kWrite);
    const io::ScopedFileFaults faults(writes);
    MemoryBudget much, small(least_bytes(given));
    SegmentStore store(temp_, much, {.allowance_bytes = kMuch});
    fill(given, store);
    NoRecords records;
    StoredHierarchy hierarchy(store, temp_, small,
                              {.bucket_exponent = given.bucket_exponent(), .background = false, .most_pages = kMuch});
    hierarchy.pair_nodes({});
    ASSERT_TRUE(hierarchy.cancel(records, {}));
    EXPECT_GE(hierarchy.spilled_bytes(), PageCache::kPageBytes * writes.count() + lists.size() / 2);
  }
}

TEST_F(StoredHierarchyTest, AGraphThatMemoryHoldsSpillsNothing) {
  made_on_disk(with_positions(bench::GraphMaker(bench::kNoise, 8'000).make(), false), kMuch);
  EXPECT_EQ(spilled_, 0u);
}

TEST_F(StoredHierarchyTest, GivesUpWhereStepsNeedTooManyPages) {
  const Given given = with_positions(bench::GraphMaker(bench::kNoise, 80'000).make(), false);
  EXPECT_TRUE(made_on_disk(given, least_bytes(given), {}, 0).empty());
  EXPECT_FALSE(made_on_disk(given, kMuch, {}, 0).empty());
  EXPECT_EQ(pages_read_again_, 0u);
}

TEST_F(StoredHierarchyTest, AFullDiskIsReported) {
  const Given given = with_positions(bench::GraphMaker(bench::kNoise, 12'000).make(), true);
  expect_failing_writes_are_reported([&](const io::TempDir& temp, MemoryBudget& budget) {
    SegmentStore store(temp, budget);
    fill(given, store);
    RecordLog records(temp, budget);
    MemoryBudget small(least_bytes(given));
    StoredHierarchy hierarchy(store, temp, small,
                              {.bucket_exponent = given.bucket_exponent(), .background = false, .most_pages = kMuch});
    hierarchy.pair_nodes({});
    EXPECT_TRUE(hierarchy.cancel(records, {}));
  });
}

TEST_F(StoredHierarchyTest, StopsWhenThePollThrows) {
  const Given given = with_positions(bench::GraphMaker(bench::kNoise, 20'000).make(), true);
  for (const double when : {0.0, 0.4, 0.7, 0.9}) {
    double before = -1;
    const auto poll = [&](double done) {
      EXPECT_GE(done, 0);
      EXPECT_LE(done, 1);
      before = done;
      if (done >= when) throw Error(ErrorKind::kInterrupted, "stop", "");
    };
    EXPECT_THROW(made_on_disk(given, kMuch, poll), Error) << when;
    EXPECT_GE(before, when);
  }
}

}  // namespace
}  // namespace reeb::ooc
