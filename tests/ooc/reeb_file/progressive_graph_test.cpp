// Refining and coarsening in place: always the level itself, and a viewer who follows the events
// sees the same.
#include "ooc/reeb_file/progressive_graph.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "ooc/reeb_file/reeb_file_writer.h"
#include "tests/ooc/reeb_file/made_up_hierarchy.h"

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

TEST(ProgressiveGraph, ManyFrames) { wander(MadeUpMaker(4).make(20'000, 120'000, 200'000), 12, 4, false); }

}  // namespace
}  // namespace reeb::ooc
