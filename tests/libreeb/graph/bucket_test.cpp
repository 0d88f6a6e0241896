// The buckets of an embedding: their indices, and the exponent for a range of values.
#include "libreeb/graph/bucket.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

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

// The bucket of these vertices, from the definition. Coordinates are small integers, so that sums are exact.
Bucket bucket_of(const std::vector<std::array<double, 3>>& points) {
  Bucket bucket{0, points.size(), {}};
  const auto n = static_cast<double>(points.size());
  for (std::size_t k = 0; k < 3; ++k) {
    for (const auto& point : points) bucket.mean[k] += point[k];
    bucket.mean[k] /= n;
  }
  if (points.size() == 1) return bucket;
  double squares = 0;
  for (const auto& point : points)
    for (std::size_t k = 0; k < 3; ++k) squares += (point[k] - bucket.mean[k]) * (point[k] - bucket.mean[k]);
  bucket.spread = static_cast<float>(squares / n);
  bucket.rim = rim_of(*std::ranges::max_element(points));
  return bucket;
}

TEST(Bucket, MergingYieldsTheSpreadAndTheRimOfAllVertices) {
  std::mt19937 random(5);
  for (int round = 0; round < 500; ++round) {
    std::vector<std::array<double, 3>> all;
    Bucket merged;
    for (int part = 1 + static_cast<int>(random() % 4); part > 0; --part) {
      std::vector<std::array<double, 3>> points(1 + random() % 5);
      for (auto& point : points)
        for (double& x : point) x = static_cast<double>(random() % 9) - 4;
      all.insert(all.end(), points.begin(), points.end());
      merge_into(merged, bucket_of(points));
    }
    const Bucket expected = bucket_of(all);
    ASSERT_EQ(merged.count, expected.count);
    ASSERT_EQ(merged.rim, expected.rim);
    ASSERT_NEAR(merged.spread, expected.spread, 1e-5 * (1 + expected.spread));
  }
}

TEST(Bucket, MergingFarFromTheOriginStaysFinite) {
  constexpr float kMost = std::numeric_limits<float>::max();
  for (const double x : {1e39, 1e160, 1.7e308}) {
    Bucket merged;
    merge_into(merged, {0, 1, {x, -x, 1}});
    merge_into(merged, {0, 1, {-x, -x, 2}});
    EXPECT_EQ(merged.count, 2u);
    EXPECT_EQ(merged.mean, (std::array{0.0, -x, 1.5}));
    EXPECT_EQ(merged.spread, kMost);
    EXPECT_EQ(merged.rim, (RimPoint{kMost, -kMost, 1}));
  }
}

TEST(Bucket, CoarseningJoinsNeighboursAndKeepsCountsAndCentres) {
  const std::vector<Bucket> fine = {{9, 7, {1, 1, 1}},  {-3, 2, {0, 0, 0}}, {-2, 6, {4, 8, -4}},
                                    {-1, 2, {5, 0, 0}}, {0, 3, {1, 2, 3}},  {3, 5, {2, 2, 2}}};
  std::vector<Bucket> buckets = fine;
  coarsen(buckets, 1, 1);  // the first is another arc's
  // Of (4, 8, -4) six times and (5, 0, 0) twice: 3/16 of the squared distance, 81.
  EXPECT_EQ(buckets, (std::vector<Bucket>{{9, 7, {1, 1, 1}},
                                          {-2, 2, {0, 0, 0}},
                                          {-1, 8, {4.25, 6, -3}, 81 * 0.1875f, {}},
                                          {0, 3, {1, 2, 3}},
                                          {1, 5, {2, 2, 2}}}));
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
