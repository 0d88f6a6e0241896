// The scope of noise removal in graphs drawn by hand. tests/ooc/stored_graph/last_noise_pass_test.cpp tests that the
// scope misses nothing.
#include "libreeb/noise/noise_scope.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace reeb {
namespace {

SweepKey key(double value) { return {value, VertexId(static_cast<std::uint64_t>(value * 4))}; }

// The values of the nodes in the scope of all short arcs.
std::vector<double> scope(const std::vector<std::pair<double, double>>& arcs, double threshold) {
  std::vector<ArcKeys> all, of_short_ones;
  for (const auto& [lo, hi] : arcs) {
    all.push_back({key(lo), key(hi)});
    if (is_short(lo, hi, threshold)) of_short_ones.push_back(all.back());
  }
  const ReebGraph graph = make_graph(all, {}), short_arcs = make_graph(of_short_ones, {});
  const Degrees of_all = degrees(graph);
  Degrees in_graph;
  for (std::size_t node = 0, next = 0; node < graph.node_count() && next < short_arcs.node_count(); ++node) {
    if (graph.nodes[node] != short_arcs.nodes[next]) continue;
    in_graph.down.push_back(of_all.down[node]);
    in_graph.up.push_back(of_all.up[node]);
    ++next;
  }
  const std::vector<bool> in_scope = noise_scope(short_arcs, in_graph);
  std::vector<double> values;
  for (std::size_t node = 0; node < in_scope.size(); ++node)
    if (in_scope[node]) values.push_back(short_arcs.nodes[node].value);
  return values;
}

using Values = std::vector<double>;

TEST(NoiseScope, IsALeafAndItsSaddle) {
  EXPECT_EQ(scope({{0, 40}, {40, 41}, {40, 90}}, 2), (Values{40, 41}));
  EXPECT_EQ(scope({{0, 50}, {49, 50}, {50, 90}}, 2), (Values{49, 50}));
  EXPECT_EQ(scope({{0, 40}, {40, 42}, {40, 90}}, 2), Values{}) << "as long as the threshold";
}

TEST(NoiseScope, IsNotWhereNoLeafIs) {
  // Loops of short arcs only; and maxima whose saddle has no other path up.
  EXPECT_EQ(scope({{0, 40}, {40, 41}, {40, 41}, {41, 42}, {42, 43}, {42, 43}, {43, 90}}, 2), Values{});
  EXPECT_EQ(scope({{0, 40}, {20, 40}, {40, 41}}, 2), Values{});
}

TEST(NoiseScope, GoesOnWhereASaddleDisappears) {
  // Without the maximum 43, 42 is contracted, and 44 has the saddle 41, which has another path up.
  EXPECT_EQ(scope({{0, 41}, {41, 42}, {41, 90}, {42, 43}, {42, 44}}, 4), (Values{41, 42, 43, 44}));
  // Here 42 cannot be contracted, since it is the upper end of a loop. So 41 is not the saddle of a leaf.
  EXPECT_EQ(scope({{0, 41}, {41, 42}, {41, 42}, {42, 43}, {42, 90}}, 4), (Values{42, 43}));
}

TEST(NoiseScope, HasThePathsBesideALeafAndNothingBeyondIt) {
  // The other path goes past the maximum 43.5 through 42 and 43, which fork into loops; 44 is above the maximum.
  EXPECT_EQ(scope({{0, 41}, {41, 43.5}, {41, 42}, {42, 43}, {42, 43}, {43, 44}, {44, 45}, {44, 45}, {45, 90}}, 4),
            (Values{41, 42, 43, 43.5}));
}

TEST(NoiseScope, OfNothingIsNothing) { EXPECT_TRUE(noise_scope({}, {}).empty()); }

}  // namespace
}  // namespace reeb
