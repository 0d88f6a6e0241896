// A copy of a list that is cut again and again has what the list has, and tells the same place of the next cut.
#include "libreeb/graph/remaining_buckets.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libreeb/graph/bucket_lists.h"
#include "tests/libreeb/hierarchy/random_graphs.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

// Vertices also beyond the ends of the arc, where moved ones may be.
std::vector<Bucket> random_list(test::Random& random) {
  std::vector<Bucket> list;
  std::int64_t index = -6;
  for (std::uint32_t i = 1 + test::below(random, 12); i > 0; --i) {
    index += 1 + test::below(random, 3);
    list.push_back({index, 1 + std::uint64_t{test::below(random, 4)} * test::below(random, 30), {1, 2, 3}});
  }
  return list;
}

TEST(RemainingBuckets, AreThoseOfTheListAfterTheSameCuts) {
  for (std::uint64_t seed = 0; seed < test::case_count(20000); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    const Direction d = test::below(random, 2) == 0 ? kUp : kDown;
    const int exponent = static_cast<int>(test::below(random, 5)) - 2;
    const auto value = [&] { return std::ldexp(static_cast<double>(test::below(random, 64)) / 4 - 4, exponent); };
    std::vector<double> at;
    for (int i = 0; i < 8; ++i) at.push_back(value());  // some are equal
    std::ranges::sort(at);
    if (d == kDown) std::ranges::reverse(at);

    PackedLists packed;
    packed.add(random_list(random));
    packed.add({});
    ArcBucketLists lists(std::move(packed), exponent);
    const ArcId from(0), into(1);
    RemainingBuckets remaining;
    remaining.start(d, at.front(), at.back(), lists.closed(from), exponent);
    double start = at.front();
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      const auto [lo, hi] = std::minmax(start, at.back());
      ASSERT_EQ(remaining.empty(), lists.empty(from));
      if (remaining.empty()) break;
      ASSERT_EQ(remaining.first_value(), lists.first_value(d, from, lo, hi));
      lists.cut(opposite(d), from, into, {lo, at[i], hi});
      remaining.cut(at[i]);
      start = at[i];
    }
  }
}

}  // namespace
}  // namespace reeb
