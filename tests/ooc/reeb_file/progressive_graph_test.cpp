// Refining and coarsening in place: the result is always the level itself, and a viewer that follows the events sees
// the same level.
#include "ooc/reeb_file/progressive_graph.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/ooc/reeb_file/made_up_hierarchy.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;

class Viewer : public GraphListener {
 public:
  void node_added(std::uint32_t node, const SettledNode& place) override {
    EXPECT_TRUE(nodes_.emplace(node, place.key).second);
  }
  void node_removed(std::uint32_t node) override {
    EXPECT_EQ(nodes_.erase(node), 1u);
    for (const auto& [arc, ends] : arcs_) EXPECT_TRUE(ends.first != node && ends.second != node);
  }
  void arc_added(std::uint64_t arc, std::uint32_t lo, std::uint32_t hi) override {
    EXPECT_TRUE(nodes_.contains(lo) && nodes_.contains(hi));
    EXPECT_TRUE(arcs_.emplace(arc, std::pair(lo, hi)).second);
  }
  void arc_removed(std::uint64_t arc) override { EXPECT_EQ(arcs_.erase(arc), 1u); }

  ReebGraph graph() const {
    std::vector<ArcKeys> arcs;
    std::vector<SweepKey> nodes;
    for (const auto& [arc, ends] : arcs_) arcs.push_back({nodes_.at(ends.first), nodes_.at(ends.second)});
    for (const auto& [node, key] : nodes_) nodes.push_back(key);
    return make_graph(arcs, nodes);
  }

 private:
  std::map<std::uint32_t, SweepKey> nodes_;
  std::map<std::uint64_t, std::pair<std::uint32_t, std::uint32_t>> arcs_;
};

void wander(const MadeUp& made, int visits, std::uint64_t seed, bool watch) {
  const std::string path = (fs::temp_directory_path() / ("reeb-progressive-" + std::to_string(getpid()))).string();
  write_hierarchy_file(path, {}, made.graph, made.hierarchy);
  const ReebFile file(path);
  Viewer viewer;
  ProgressiveGraph graph(file, watch ? &viewer : nullptr);
  std::mt19937_64 random(seed);
  for (int i = 0; i < visits; ++i) {
    const auto version = static_cast<std::uint32_t>(random() % (made.hierarchy.persistence.size() + 1));
    graph.go_to_version(version);
    ReebGraph expected = naive_level(made, version);
    ASSERT_EQ(graph.graph(), expected) << "version " << version;
    ASSERT_EQ(graph.node_count(), expected.node_count());
    // One frame introduces fewer than 5,000 nodes.
    EXPECT_LE(graph.memory_bytes(), level_memory(expected.node_count() + 5000, expected.arc_count(), 0));
    expected.positions.clear();
    if (watch) {
      ASSERT_EQ(viewer.graph(), expected);
    }
  }
  fs::remove(path);
}

TEST(ProgressiveGraph, SmallFilesEverywhere) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    wander(MadeUpMaker(seed).make(static_cast<std::uint32_t>(seed % 30), 60, 20), 12, seed, true);
  }
}

// The change is made as a whole, and later ones, too.
TEST(ProgressiveGraph, AListenerThatThrowsChangesNothing) {
  class Thrower : public GraphListener {
   public:
    explicit Thrower(int calls) : calls_(calls) {}
    void node_added(std::uint32_t, const SettledNode&) override { count(); }
    void node_removed(std::uint32_t) override { count(); }
    void arc_added(std::uint64_t, std::uint32_t, std::uint32_t) override { count(); }
    void arc_removed(std::uint64_t) override { count(); }
    int thrown = 0;

   private:
    void count() {
      if (calls_-- > 0) return;
      ++thrown;
      throw 7;
    }
    int calls_;
  };
  const MadeUp made = MadeUpMaker(3).make(25, 60, 20);
  const Scratch scratch;
  const std::string path = scratch.path() + "/a.reeb";
  write_hierarchy_file(path, {}, made.graph, made.hierarchy);
  const ReebFile file(path);
  const auto last = static_cast<std::uint32_t>(made.hierarchy.persistence.size());
  for (int calls = 0; calls < 60; ++calls) {
    Thrower thrower(calls);
    ProgressiveGraph graph(file, &thrower);
    for (const std::uint32_t version : {last, 0u, last / 2, last, 1u}) {
      try {
        graph.go_to_version(version);
      } catch (int) {
      }
      ASSERT_EQ(graph.graph(), naive_level(made, version)) << calls << " calls, version " << version;
    }
    EXPECT_EQ(thrower.thrown, 1) << calls;
  }
}

TEST(ProgressiveGraph, ManyFrames) { wander(MadeUpMaker(4).make(20'000, 120'000, 200'000), 12, 4, false); }

// Given a threshold, nodes or memory, it goes to the level that the file itself loads for them.
TEST(ProgressiveGraph, GoesToTheLevelThatTheFileChooses) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/made.reeb";
  const MadeUp made = MadeUpMaker(7).make(300, 900, 200);
  write_hierarchy_file(path, {}, made.graph, made.hierarchy);
  const ReebFile file(path);
  ProgressiveGraph graph(file);
  const auto expect_level = [&](std::uint32_t version) {
    EXPECT_EQ(graph.version(), version);
    EXPECT_EQ(graph.graph(), file.load(version).graph);
  };
  const std::uint32_t steps = file.header().steps;
  ASSERT_GT(steps, 20u);
  std::set<std::uint32_t> seen;
  for (std::uint32_t step = 0; step <= steps; step += 3) {
    const Level level = file.load(step);
    SCOPED_TRACE(testing::Message() << "version " << step);
    graph.go_to_threshold(level.threshold);
    expect_level(file.version_at(level.threshold));
    seen.insert(graph.version());
    graph.go_to_nodes(level.graph.node_count());
    expect_level(file.finest_with_nodes(level.graph.node_count()));
    EXPECT_LE(graph.node_count(), level.graph.node_count());
    const std::uint64_t memory = level_memory(level.graph.node_count(), level.graph.arc_count(), 0);
    graph.go_to_memory(memory);
    expect_level(file.finest_with_memory(memory));
    EXPECT_LE(level_memory(graph.node_count(), graph.arc_count(), 0), memory);
  }
  EXPECT_GT(seen.size(), 10u);
}

TEST(ProgressiveGraph, ALevelThatIsNotThereIsRefused) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/made.reeb";
  const MadeUp made = MadeUpMaker(3).make(30, 60, 20);
  write_hierarchy_file(path, {}, made.graph, made.hierarchy);
  const ReebFile file(path);
  ProgressiveGraph graph(file);
  const std::uint32_t steps = file.header().steps;
  EXPECT_THROW(graph.go_to_version(steps + 1), Error);
  EXPECT_TRUE(graph.empty());
  graph.go_to_version(steps);
  const ReebGraph before = graph.graph();
  for (const std::uint32_t version : {steps + 1, std::numeric_limits<std::uint32_t>::max()}) {
    EXPECT_THROW(graph.go_to_version(version), Error);
    EXPECT_THROW(file.load(version), Error);
  }
  EXPECT_THROW(graph.go_to_nodes(0), Error);
  EXPECT_THROW(graph.go_to_memory(0), Error);
  EXPECT_EQ(graph.version(), steps);
  EXPECT_EQ(graph.graph(), before);
}

}  // namespace
}  // namespace reeb::ooc
