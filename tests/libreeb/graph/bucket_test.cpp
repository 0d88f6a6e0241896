// The buckets of an embedding: their indices, and the exponent for a range of values.
#include "libreeb/graph/bucket.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace reeb {
namespace {

TEST(Bucket, AValueLiesBetweenTheBoundsOfItsBucket) {
  EXPECT_EQ(bucket_index(0.0, 0), 0);
  EXPECT_EQ(bucket_index(0.75, -2), 3);
  EXPECT_EQ(bucket_index(-0.75, -2), -3);
  EXPECT_EQ(bucket_index(-0.8, -2), -4);
  EXPECT_EQ(bucket_index(1e300, 997), static_cast<std::int64_t>(std::floor(std::ldexp(1e300, -997))));
}

TEST(Bucket, TheExponentIsTheLeastThatSpansTheRangeInTwiceTheBuckets) {
  const auto spanned = [](double min, double max, int h) { return bucket_index(max, h) - bucket_index(min, h) + 1; };
  EXPECT_EQ(bucket_exponent(0, 1, 1), 0);  // 1 is in the bucket after that of 0
  EXPECT_EQ(bucket_exponent(0, 255, 64), 1);
  EXPECT_EQ(bucket_exponent(0, 256, 64), 2);
  for (const auto& [min, max] : {std::pair{-3.0, 7.5}, {1e-300, 3e-300}, {-1e308, 1e308}, {100.0, 100.125}})
    for (const std::uint32_t buckets : {1u, 7u, 64u, 1000u}) {
      const int h = bucket_exponent(min, max, buckets);
      EXPECT_LE(spanned(min, max, h), 2 * buckets);
      EXPECT_GT(spanned(min, max, h - 1), 2 * buckets);
    }
}

TEST(Bucket, ASingleValueHasAnExactIndex) {
  for (const double value : {0.0, 1.0, -1.0, 1e308, -5e-324}) {
    const int h = bucket_exponent(value, value, 64);
    EXPECT_EQ(std::ldexp(static_cast<double>(bucket_index(value, h)), h), value);
  }
}

TEST(Bucket, TheExponentNeverFallsWhenTheRangeGrows) {
  const double whole = std::numeric_limits<double>::max();
  EXPECT_LE(bucket_exponent(-whole, whole, 1), 1100);
  double min = 0.1, max = 0.1;
  for (int last = bucket_exponent(min, max, 16), i = 0; i < 1000; ++i) {
    (i % 3 == 0 ? min : max) += (i % 3 == 0 ? -1 : 1) * std::ldexp(1.0, i % 200 - 100);
    const int h = bucket_exponent(min, max, 16);
    EXPECT_GE(h, last);
    last = h;
  }
}

TEST(Bucket, CoarseningJoinsNeighboursAndKeepsCountsAndCentres) {
  const std::vector<Bucket> fine = {{9, 7, {1, 1, 1}},  {-3, 2, {0, 0, 0}}, {-2, 6, {4, 8, -4}},
                                    {-1, 2, {5, 0, 0}}, {0, 3, {1, 2, 3}},  {3, 5, {2, 2, 2}}};
  std::vector<Bucket> buckets = fine;
  coarsen(buckets, 1, 1);  // the first is another arc's
  EXPECT_EQ(buckets,
            (std::vector<Bucket>{
                {9, 7, {1, 1, 1}}, {-2, 2, {0, 0, 0}}, {-1, 8, {4.25, 6, -3}}, {0, 3, {1, 2, 3}}, {1, 5, {2, 2, 2}}}));
  buckets = fine;
  coarsen(buckets, 1, 2000);
  EXPECT_EQ(buckets.size(), 3u);
  EXPECT_EQ(buckets[1].index, -1);
  EXPECT_EQ(buckets[1].count, 10u);
  EXPECT_EQ(buckets[2].count, 8u);
  buckets = fine;
  coarsen(buckets, 0, 0);
  EXPECT_EQ(buckets, fine);
}

}  // namespace
}  // namespace reeb
