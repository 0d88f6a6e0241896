// Which loops are likely defects: a gap in their persistences.
#include "libreeb/defects/small_loops.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace reeb {
namespace {

std::pair<std::uint64_t, double> found(const std::vector<double>& ascending, double range = 100) {
  LikelyDefects defects(range);
  for (const double persistence : ascending) defects.add(persistence);
  const SmallLoops small = defects.found();
  return {small.count, small.persistence};
}

TEST(SmallLoops, EndAtTheWidestGap) {
  EXPECT_EQ(found({0.1, 0.12, 0.2, 40, 50}), std::pair(3ul, 0.2));
  EXPECT_EQ(found({0.01, 0.05, 0.06, 1.5, 40}), std::pair(4ul, 1.5)) << "1.5 to 40 is wider than 0.06 to 1.5";
  EXPECT_EQ(found({0.001, 0.06, 1.5, 40}), std::pair(1ul, 0.001)) << "0.001 to 0.06 is wider than 1.5 to 40";
}

TEST(SmallLoops, AreAllLoopsIfAllAreSmall) { EXPECT_EQ(found({0.1, 0.2, 0.3}), std::pair(3ul, 0.3)); }

TEST(SmallLoops, AreNoneWithoutAGap) {
  EXPECT_EQ(found({}), std::pair(0ul, 0.0));
  EXPECT_EQ(found({99}), std::pair(0ul, 0.0));
  EXPECT_EQ(found({2.1, 80}), std::pair(0ul, 0.0)) << "more than 2 % of the range";
  EXPECT_EQ(found({1, 2, 4, 8, 16, 32, 64}), std::pair(0ul, 0.0));
  EXPECT_EQ(found({0, 0}), std::pair(0ul, 0.0)) << "loops without persistence are no defects that can be placed";
}

}  // namespace
}  // namespace reeb
