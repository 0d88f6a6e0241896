// Layouts of random graphs: heights are values, arcs rise from end to end, places are apart.
#include "io/plot/graph_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "io/plot/dot_layout.h"

namespace reeb::io {
namespace {

ReebGraph random_graph(std::mt19937_64& random, std::size_t nodes, std::size_t arcs) {
  std::vector<SweepKey> keys;
  for (std::size_t i = 0; i < nodes; ++i)
    keys.push_back({static_cast<double>(random() % (2 * nodes)), VertexId(static_cast<std::uint32_t>(i))});
  std::vector<ArcKeys> made;
  while (made.size() < arcs) {
    const SweepKey a = keys[random() % nodes], b = keys[random() % nodes];
    if (a < b) made.push_back({a, b});
  }
  return make_graph(made, keys);
}

void check(const ReebGraph& graph, const GraphLayout& layout) {
  const std::vector<double> height = heights(graph);
  ASSERT_EQ(layout.nodes.size(), graph.node_count());
  ASSERT_EQ(layout.arcs.size(), graph.arc_count());
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    EXPECT_GE(layout.nodes[i].x, 0);
    EXPECT_LE(layout.nodes[i].x, 1);
    EXPECT_EQ(layout.nodes[i].y, height[i]);
    EXPECT_GE(height[i], i == 0 ? 0 : height[i - 1]);
  }
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const auto& curve = layout.arcs[arc];
    ASSERT_EQ(curve.size() % 3, 1u);
    EXPECT_EQ(curve.front().y, height[graph.lo[arc].value()]);
    EXPECT_EQ(curve.back().y, height[graph.hi[arc].value()]);
    EXPECT_EQ(curve.front().x, layout.nodes[graph.lo[arc].value()].x);
    for (const PicturePoint& point : curve) {
      EXPECT_GE(point.y, curve.front().y);
      EXPECT_LE(point.y, curve.back().y);
    }
  }
}

TEST(GraphLayout, OfRandomGraphsRises) {
  std::mt19937_64 random(17);
  for (int round = 0; round < 50; ++round) {
    const std::size_t nodes = 2 + random() % 60;
    const ReebGraph graph = random_graph(random, nodes, random() % (2 * nodes));
    check(graph, layered_layout(graph));
  }
}

TEST(GraphLayout, OfOneNodeAndOfNothing) {
  const ReebGraph one = make_graph({}, {{3, VertexId(0)}});
  const GraphLayout layout = layered_layout(one);
  ASSERT_EQ(layout.nodes.size(), 1u);
  EXPECT_EQ(layout.nodes[0].x, 0.5);
  EXPECT_EQ(layout.nodes[0].y, 0.5);
  EXPECT_TRUE(layered_layout({}).nodes.empty());
}

TEST(GraphLayout, SeparatesParallelArcs) {
  const SweepKey a{0, VertexId(0)}, b{1, VertexId(1)};
  const GraphLayout layout = layered_layout(make_graph({{a, b}, {a, b}, {a, b}}, {}));
  std::set<double> bends;
  for (const auto& curve : layout.arcs) bends.insert(curve[1].x);
  EXPECT_EQ(bends.size(), 3u);
}

// Branches from one fork are beside each other.
TEST(GraphLayout, PutsLeavesApart) {
  std::vector<ArcKeys> arcs;
  const SweepKey root{0, VertexId(0)};
  for (std::uint32_t i = 1; i <= 20; ++i) arcs.push_back({root, {1, VertexId(i)}});
  const GraphLayout layout = layered_layout(make_graph(arcs, {}));
  std::set<double> places;
  for (std::size_t i = 1; i < layout.nodes.size(); ++i) places.insert(layout.nodes[i].x);
  EXPECT_EQ(places.size(), 20u);
}

// A fork with `leaves` leaves, `points` isolated nodes and `lone` components of one arc, all in the same few heights.
ReebGraph graph_with_specks(std::uint32_t leaves, std::uint32_t points, std::uint32_t lone) {
  std::vector<ArcKeys> arcs;
  std::vector<SweepKey> nodes;
  std::uint32_t next = 0;
  const SweepKey root{0, VertexId(next++)};
  for (std::uint32_t i = 0; i < leaves; ++i) arcs.push_back({root, {100, VertexId(next++)}});
  for (std::uint32_t i = 0; i < points; ++i) nodes.push_back({static_cast<double>(i % 90), VertexId(next++)});
  for (std::uint32_t i = 0; i < lone; ++i) {
    const SweepKey lo{static_cast<double>(i % 50), VertexId(next++)}, hi{lo.value + 1 + i % 40, VertexId(next++)};
    arcs.push_back({lo, hi});
  }
  return make_graph(arcs, nodes);
}

// What is drawn of components of one node or one arc is to the right of all else, and apart.
void check_specks(const ReebGraph& graph, const GraphLayout& layout) {
  constexpr double kAspect = 752.0 / 578;  // of the picture's inside
  const Degrees degree = degrees(graph);
  double edge = 0, first = 1;
  std::vector<std::array<double, 3>> drawn;  // across, from, to
  std::size_t left_out = 0;
  const auto add = [&](std::size_t lo, std::size_t hi) {
    EXPECT_EQ(layout.parts[lo], layout.parts[hi]);
    if (layout.parts[lo] == GraphLayout::Part::kLeftOut) return void(++left_out);
    EXPECT_EQ(layout.parts[lo], GraphLayout::Part::kSpeck);
    EXPECT_EQ(layout.nodes[lo].x, layout.nodes[hi].x);
    first = std::min(first, layout.nodes[lo].x);
    drawn.push_back({layout.nodes[lo].x, layout.nodes[lo].y, layout.nodes[hi].y});
  };
  const auto all = [&](NodeId node) { return degree.down[node.value()] + degree.up[node.value()]; };
  for (std::uint32_t i = 0; i < graph.node_count(); ++i)
    if (all(NodeId(i)) == 0) add(i, i);
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    if (all(graph.lo[arc]) == 1 && all(graph.hi[arc]) == 1)
      add(graph.lo[arc].value(), graph.hi[arc].value());
    else
      for (const PicturePoint& point : layout.arcs[arc]) edge = std::max(edge, point.x);
  }
  EXPECT_EQ(left_out, layout.left_out);
  EXPECT_LT(edge, first);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double across = std::abs(drawn[i][0] - drawn[j][0]);
      const double upwards = std::max(drawn[i][1] - drawn[j][2], drawn[j][1] - drawn[i][2]) / kAspect;
      EXPECT_GT(std::max(across, upwards), 0.7 * layout.speck_distance);
    }
}

TEST(GraphLayout, PutsSmallComponentsToTheRight) {
  for (const auto& [points, lone] : {std::pair(1u, 0u), {0u, 1u}, {40u, 10u}, {200u, 20u}}) {
    const ReebGraph graph = graph_with_specks(30, points, lone);
    const GraphLayout layout = layered_layout(graph);
    check(graph, layout);
    check_specks(graph, layout);
    EXPECT_EQ(layout.left_out, 0u);
  }
}

TEST(GraphLayout, LeavesOutTheSmallestOfTooManyComponents) {
  const ReebGraph graph = graph_with_specks(30, 5000, 20);
  const GraphLayout layout = layered_layout(graph);
  check(graph, layout);
  check_specks(graph, layout);
  EXPECT_GT(layout.left_out, 1000u);
  EXPECT_LT(layout.left_out, 4700u);
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc)
    EXPECT_NE(layout.parts[graph.lo[arc].value()], GraphLayout::Part::kLeftOut);
}

// Values at the ends of double's range have a height between 0 and 1.
TEST(GraphLayout, HasHeightsOfHugeValues) {
  const ReebGraph graph = make_graph({}, {{-1.7e308, VertexId(0)}, {0, VertexId(1)}, {1.7e308, VertexId(2)}});
  EXPECT_EQ(heights(graph), (std::vector<double>{0, 0.5, 1}));
}

TEST(DotLayout, ReadsWhatDotWrites) {
  // A loop of two arcs, and a speck that dot does not see.
  const SweepKey a{0, VertexId(0)}, b{10, VertexId(1)}, c{4, VertexId(2)}, d{5, VertexId(3)};
  const ReebGraph graph = make_graph({{a, b}, {a, b}, {c, d}}, {});
  const std::string text = dot_text(graph);
  EXPECT_NE(text.find("0 -- 3;"), std::string::npos);
  EXPECT_EQ(text.find("1 -- 2;"), std::string::npos);
  const std::string plain =
      "graph 1 2 10\nnode 0 1 0 0.1 0.1 \"\" solid circle black lightgrey\nnode 3 1 9 0.1 0.1 \"\" solid circle black "
      "lightgrey\nnode r0 2 0 0.1 0.1 r0 solid circle black lightgrey\nnode r35 2 10 0.1 0.1 r35 solid circle black "
      "lightgrey\nedge r0 r1 4 2 0 2 1 2 2 2 3 invis black\nedge 0 3 4 1 0 0.5 3 0.5 6 1 9 solid black\n"
      "edge 0 3 4 1 0 1.5 3 1.5 6 1 9 solid black\nstop\n";
  const auto layout = read_dot_layout(graph, plain);
  ASSERT_TRUE(layout);
  check(graph, *layout);
  EXPECT_LT(layout->arcs[0][1].x, layout->arcs[1][1].x);
  check_specks(graph, *layout);
}

// Both ends of a nearly level arc are in one row, and dot lists the points of its curve from either end.
TEST(DotLayout, TurnsLevelArcs) {
  const ReebGraph graph =
      make_graph({{{0, VertexId(0)}, {0.1, VertexId(1)}}, {{0, VertexId(0)}, {10, VertexId(2)}}}, {});
  const std::string begin =
      "graph 1 4 10\nnode 0 3 0 0.1 0.1 \"\" solid circle black lightgrey\nnode 1 1 0 0.1 0.1 \"\" solid circle black "
      "lightgrey\nnode 2 3 10 0.1 0.1 \"\" solid circle black lightgrey\nnode r0 4 0 0.1 0.1 r0 solid circle black "
      "lightgrey\nnode r35 4 10 0.1 0.1 r35 solid circle black lightgrey\nedge 0 2 4 3 0 3 3 3 6 3 10 solid black\n";
  for (const char* curve : {"4 3 0 2.5 0.1 1.5 0.1 1 0", "4 1 0 1.5 0.1 2.5 0.1 3 0"}) {
    const auto layout = read_dot_layout(graph, begin + "edge 0 1 " + curve + " solid black\nstop\n");
    ASSERT_TRUE(layout);
    check(graph, *layout);
    EXPECT_GT(layout->arcs[0][1].x, layout->arcs[0][2].x) << curve;
  }
}

TEST(DotLayout, RefusesWhatIsNoLayout) {
  const ReebGraph graph = make_graph({{{0, VertexId(0)}, {1, VertexId(1)}}, {{0, VertexId(0)}, {2, VertexId(2)}}}, {});
  for (const char* plain : {"", "nonsense", "node 0 1 2\n", "node 9 1 2 3\n", "node 0 x y\nedge 0 1\n",
                            "node 0 1 1\nnode 1 1 1\nnode 2 1 1\n", "edge 0 1 3 1 1 1 1 1 1\n"})
    EXPECT_FALSE(read_dot_layout(graph, plain)) << plain;
}

}  // namespace
}  // namespace reeb::io
