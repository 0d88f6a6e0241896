// PathFollower against following arc by arc, in graphs that change between calls and while a path is followed.
#include "libreeb/hierarchy/path_follower.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

constexpr ArcId kNone = WorkingGraph::kNone;
constexpr std::uint32_t kNodes = 2000, kSpare = 100;

// A path through every second node, arcs that leave it and skip nodes, shorter paths into it through the other nodes,
// and spare arcs far below it.
ReebGraph with_a_long_path(Random& random) {
  ReebGraph graph;
  for (std::uint32_t node = 0; node < kNodes; ++node)
    graph.nodes.push_back({static_cast<double>(node), VertexId(node)});
  const auto add = [&](std::uint32_t lo, std::uint32_t hi) {
    graph.lo.emplace_back(lo);
    graph.hi.emplace_back(hi);
  };
  for (std::uint32_t arc = 0; arc < kSpare; ++arc) add(0, 1);
  for (std::uint32_t node = 2; node + 2 < kNodes; node += 2) {
    add(node, node + 2);
    if (random.chance(20)) add(node, node + 3 + static_cast<std::uint32_t>(random.below(kNodes - node - 3)));
    if (node % 64 > 32) add(node + 1, node % 64 == 62 ? node + 2 : node + 3);
  }
  return graph;
}

class Fixture {
 public:
  explicit Fixture(std::uint64_t seed)
      : random_(seed), full_(with_a_long_path(random_)), graph_(full_), follower_(graph_) {}

  void change() {
    const std::uint64_t kind = random_.below(5);
    if (kind == 4) {  // to the next path and back
      const NodeId from = node();
      move(graph_.nearest(from, kUp), kUp, NodeId(from.value() + 1 + below(4)));
    }
    if (kind == 0) contract(node());
    if (kind == 1) put_between(node());
    if (kind == 2 && random_.chance(30)) remove(arc());
    if (kind == 3 && random_.chance(30)) move(arc(), random_.chance(50) ? kUp : kDown, node());
  }

  void expect_same_way() {
    const Direction d = random_.chance(50) ? kUp : kDown;
    const NodeId from = node(), limit = node();
    if (graph_.nearest(from, kUp) == kNone && graph_.nearest(from, kDown) == kNone) return;
    const auto passes = [&](NodeId node) { return along(d, node) <= along(d, limit); };
    NodeId expected = from;
    for (ArcId arc = graph_.nearest(from, d); arc != kNone && passes(graph_.end(arc, d));
         arc = graph_.nearest(expected, d))
      expected = graph_.end(arc, d), ++steps_;
    ASSERT_EQ(follower_.follow(from, d, [&](NodeId to) { return ++looks_, passes(to); }), expected);
  }
  std::size_t steps() const { return steps_; }
  std::size_t looks() const { return looks_; }

 private:
  NodeId node() { return NodeId(2 + below(kNodes - 8)); }
  ArcId arc() { return ArcId(kSpare + below(graph_.end_arc().value() - kSpare)); }
  std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(random_.below(limit)); }

  void note_ends(ArcId arc) {
    follower_.note(graph_.end(arc, kDown), kUp);
    follower_.note(graph_.end(arc, kUp), kDown);
  }
  void remove(ArcId arc) {
    if (!graph_.alive(arc)) return;
    note_ends(arc);
    graph_.remove(arc);
  }
  void move(ArcId arc, Direction d, NodeId node) {
    if (arc == kNone || !graph_.alive(arc) || along(d, graph_.end(arc, opposite(d))) >= along(d, node)) return;
    note_ends(arc);
    graph_.move_end(arc, d, node);
    note_ends(arc);
  }
  void contract(NodeId node) {
    if (!graph_.is_regular(node)) return;
    const ArcId lower = graph_.nearest(node, kDown), upper = graph_.nearest(node, kUp);
    const NodeId end = graph_.end(upper, kUp);
    remove(upper);
    move(lower, kUp, end);
  }
  // Inserts a node without arcs into the nearest arc from below it.
  void put_between(NodeId node) {
    const NodeId below(node.value() - 1);
    const ArcId arc = graph_.nearest(below, kUp);
    if (spare_ == ArcId(kSpare) || arc == kNone || graph_.end(arc, kUp) <= node || graph_.nearest(node, kUp) != kNone)
      return;
    const NodeId end = graph_.end(arc, kUp);
    move(arc, kUp, node);
    move(spare_, kUp, end);
    move(spare_, kDown, node);
    ++spare_;
  }

  Random random_;
  const ReebGraph full_;
  WorkingGraph graph_;
  PathFollower<> follower_;
  ArcId spare_;
  std::size_t steps_ = 0, looks_ = 0;
};

TEST(PathFollower, GoesTheSameWayWhateverChanges) {
  const std::uint64_t base = base_seed();
  std::size_t steps = 0, looks = 0;
  for (std::uint64_t i = 0; i < case_count(20000) && !testing::Test::HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    Fixture fixture(base + i);
    for (int round = 0; round < 200 && !testing::Test::HasFatalFailure(); ++round) {
      for (std::uint64_t changes = i % 4; changes > 0; --changes) fixture.change();
      fixture.expect_same_way();
    }
    steps += fixture.steps();
    looks += fixture.looks();
  }
  EXPECT_LT(looks, steps / 2) << "few steps were saved";
}

}  // namespace
}  // namespace reeb::test
