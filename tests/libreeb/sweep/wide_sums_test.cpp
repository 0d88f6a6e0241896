// Wide sums against BucketSum::add(), which adds one vertex after the other: all bits are equal.
#include "libreeb/sweep/wide_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "libreeb/sweep/avx2.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

class WideSums : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_avx2()) GTEST_SKIP() << "this processor has no AVX2";
  }

  // Adds them to this number of sums, and to as many buckets; returns how many add_wide() added.
  static std::size_t compare(const std::vector<Point>& points, const std::vector<std::uint32_t>& buckets,
                             std::size_t count) {
    std::vector<WideSum> wide(count + 1);
    const std::size_t added = add_wide(wide, buckets, points);
    std::vector<BucketSum> expected(count);
    for (std::size_t i = 0; i < added; ++i)
      if (buckets[i] < count) expected[buckets[i]].add(points[i]);
    for (std::size_t b = 0; b < count; ++b) EXPECT_TRUE(wide[b].to_bucket() == expected[b]) << "bucket " << b;
    return added;
  }
  // The same with a single bucket, to which all are added.
  static void compare_all(const std::vector<Point>& points) {
    EXPECT_EQ(compare(points, std::vector<std::uint32_t>(points.size()), 1), points.size());
  }
};

TEST_F(WideSums, AreThoseOfSingleVertices) {
  const std::uint64_t seed = base_seed(), cases = case_count(1000);
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "case " << i);
    Random random(seed + i);
    // Of any size; or in a grid, so that x and y often do not tell which is greater; or in single precision.
    const std::uint64_t kind = random.below(3);
    const auto coordinate = [&] {
      if (kind == 0) return std::ldexp(random.unit() - 0.5, static_cast<int>(random.below(80)) - 56);
      if (kind == 1) return (static_cast<double>(random.below(3)) - 1) * 0x1p-60;
      return static_cast<double>(static_cast<float>(1000 * random.unit() - 500));
    };
    std::vector<Point> points(random.below(300));
    for (Point& point : points) point = {coordinate(), coordinate(), coordinate()};
    const std::size_t count = random.below(9);
    std::vector<std::uint32_t> buckets(points.size());
    for (std::uint32_t& bucket : buckets)
      bucket = random.chance(20) ? ~std::uint32_t{0} - static_cast<std::uint32_t>(random.below(2))
                                 : static_cast<std::uint32_t>(random.below(count + 1));
    EXPECT_EQ(compare(points, buckets, count), points.size());
  }
}

TEST_F(WideSums, HoldTheGreatestCoordinatesOfManyVertices) {
  const double most = std::nextafter(0x1p24 / std::sqrt(3), 0), odd = most - 0x1p-29;
  for (const double x : {most, -most, odd, -odd, 0x1p-44, -0x1p-44, 1e7 + 0x1p-29})
    compare_all(std::vector<Point>(std::size_t{1} << 19, {x, -x, x / 3}));
}

TEST_F(WideSums, StopAtAVertexThatIsTooFar) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double far : {0x1p24, -0x1p24, 1e300, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()})
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<Point> points(5, {1, 2, 3});
      for (const std::size_t i : {0u, 2u, 4u}) {
        points[i][k] = far;
        EXPECT_EQ(compare(points, std::vector<std::uint32_t>(5), 1), i) << far << " at " << k;
        points[i][k] = 0;
      }
    }
}

TEST_F(WideSums, StopBeforeTheyRound) {
  const std::vector<Point> points((std::size_t{1} << 19) + 5, {1, 2, 3});
  EXPECT_EQ(compare(points, std::vector<std::uint32_t>(points.size()), 1), std::size_t{1} << 19);
}

TEST_F(WideSums, HaveARimWithoutSignsOfZero) {
  compare_all({{-1e-60, 0, -0.0}, {0, 1, 0}, {-0.0, 1, -0.0}});
  std::vector<WideSum> sums(2);
  add_wide(sums, std::vector<std::uint32_t>(1), std::vector<Point>{{-0.0, -1e-60, -0.0}});
  for (const float x : sums[0].to_bucket().rim) EXPECT_FALSE(std::signbit(x));
}

}  // namespace
}  // namespace reeb::test
