#include "ooc/stored_hierarchy/introduced_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

SettledNode node_of(std::uint32_t rank) {
  return {{static_cast<double>(rank), VertexId(3 * std::uint64_t{rank})}, {1.0, static_cast<double>(rank), 2.0}};
}

class IntroducedNodesTest : public testing::Test {
 protected:
  static constexpr std::uint32_t kNodes = 50'000;
  IntroducedNodesTest() {
    for (std::uint32_t rank = 0; rank < kNodes; ++rank) nodes_.set(NodeId(rank), node_of(rank));
  }

  const Scratch scratch_;
  const io::TempDir temp_{scratch_.path()};
  MemoryBudget budget_;
  StoredNodes nodes_{temp_, budget_, kNodes, 0};
};

TEST_F(IntroducedNodesTest, ComeByFrameThenByRank) {
  for (const bool background : {false, true}) {
    IntroducedNodes introduced(temp_, budget_, {.allowance_bytes = 256 << 10, .background = background});
    std::mt19937 random(5);
    std::vector<std::tuple<std::uint32_t, std::uint32_t>> order;  // frame, rank
    for (std::uint32_t rank = 0; rank < kNodes; ++rank) order.emplace_back(random() % 40, rank);
    std::ranges::shuffle(order, random);
    for (const auto& [frame, rank] : order) introduced.add(NodeId(rank), frame);
    std::ranges::sort(order);
    for (const auto& [frame, rank] : order) {
      const SettledNode node = introduced.next(NodeId(rank), nodes_), expected = node_of(rank);
      ASSERT_EQ(node.key, expected.key);
      ASSERT_EQ(node.position, expected.position);
    }
    EXPECT_GT(introduced.spilled_bytes(), kNodes * 40u);
    EXPECT_THROW(introduced.next(NodeId(0), nodes_), std::logic_error) << "there is no other";
  }
}

TEST_F(IntroducedNodesTest, AnotherOrderIsRefused) {
  IntroducedNodes introduced(temp_, budget_, {.background = false});
  introduced.add(NodeId(2), 0);
  introduced.add(NodeId(1), 0);
  EXPECT_THROW(introduced.next(NodeId(2), nodes_), std::logic_error);
}

}  // namespace
}  // namespace reeb::ooc
