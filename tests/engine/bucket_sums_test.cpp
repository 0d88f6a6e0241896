// Bucket sums against plain ones: exact, so that no order of adding shows; and lists of buckets
// against maps (DESIGN.md 5).
#include "libreeb/engine/bucket_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

bool same(const BucketSum& a, const BucketSum& b) {
  return a.index == b.index && a.count == b.count && a.sum == b.sum;
}

// Of any magnitude and sign; beyond what the sums hold, too.
Point random_point(Random& random) {
  Point point;
  for (double& x : point)
    x = std::ldexp(random.unit() - 0.5, static_cast<int>(random.below(120)) - 60);
  return point;
}

TEST(BucketSum, DoesNotDependOnTheOrderOfAdding) {
  const std::uint64_t seed = base_seed(), cases = case_count(300);
  for (std::uint64_t i = 0; i < cases; ++i) {
    Random random(seed + i);
    std::vector<Point> points(1 + random.below(200));
    for (Point& point : points) point = random_point(random);
    BucketSum in_order;
    for (const Point& point : points) in_order.add(point);

    random.shuffle(points);
    std::vector<BucketSum> parts(1 + random.below(8));
    for (const Point& point : points) parts[random.below(parts.size())].add(point);
    while (parts.size() > 1) {
      random.shuffle(parts);
      parts[parts.size() - 2].add(parts.back());
      parts.pop_back();
    }
    ASSERT_TRUE(same(parts[0], in_order)) << "case " << i;
  }
}

TEST(BucketSum, RoundsToItsUnitAndCutsOffWhatItCannotHold) {
  const double unit = 0x1p-44, most = 0x1p50;
  const auto mean = [](double x) {
    BucketSum sum;
    sum.add(Point{x, 0, 0});
    return sum.mean().mean[0];
  };
  for (const double x : {0.0, 1.5, -1.5, unit, -unit, 0x1p18, -0x1p18, 0x1p18 + 0x1p-34, most, -most, 1e15 + 0.125})
    EXPECT_EQ(mean(x), x);
  EXPECT_EQ(mean(unit / 2), 0);
  EXPECT_EQ(mean(1 + unit * 1.5), 1 + unit);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(mean(2 * most), most);
  EXPECT_EQ(mean(infinity), most);
  EXPECT_EQ(mean(-1e308), -most);
  EXPECT_EQ(mean(std::numeric_limits<double>::quiet_NaN()), -most);
}

TEST(BucketSum, HoldsAsManyOfTheGreatestAsThereAreVertices) {
  BucketSum sum;
  sum.add(Point{0x1p50, -0x1p50, 0});
  for (int doublings = 0; doublings < 32; ++doublings) sum.add(BucketSum(sum));
  EXPECT_EQ(sum.count, std::uint64_t{1} << 32);
  EXPECT_EQ(sum.mean().mean, (std::array<double, 3>{0x1p50, -0x1p50, 0}));
}

TEST(BucketSum, LosesNothingWhenItIsDivided) {
  const std::uint64_t seed = base_seed(), cases = case_count(1000);
  for (std::uint64_t i = 0; i < cases; ++i) {
    Random random(seed + i);
    BucketSum whole{3, 0, {}};
    for (std::uint64_t n = 1 + random.below(50); n > 0; --n) whole.add(random_point(random));
    BucketSum rest = whole;
    const std::uint64_t taken = random.below(whole.count + 1);
    BucketSum part = rest.take(taken);
    ASSERT_EQ(part.count, taken);
    ASSERT_EQ(part.index, whole.index);
    part.add(rest);
    ASSERT_TRUE(same(part, whole)) << "case " << i;
  }
}

// A list and what it should hold: buckets of the pool's exponent by index.
struct Model {
  BucketLists::List list;
  std::map<std::int64_t, BucketSum> buckets;

  void add(const BucketSum& bucket) {
    const auto at = buckets.try_emplace(bucket.index, BucketSum{bucket.index, 0, {}}).first;
    at->second.add(bucket);
  }
  void add_all(Model& other) {
    for (const auto& [index, bucket] : other.buckets) add(bucket);
    other.buckets.clear();
  }
  void coarsen(int levels) {
    Model coarse;
    for (auto [index, bucket] : buckets) {
      bucket.index >>= levels;
      coarse.add(bucket);
    }
    buckets = std::move(coarse.buckets);
  }
};

// Any sequence of what the engine does to lists, against maps that know nothing of exponents that lag.
TEST(BucketLists, HoldWhatMapsHold) {
  const std::uint64_t seed = base_seed(), cases = case_count(1000);
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "case " << i);
    Random random(seed + i);
    BucketLists lists;
    int exponent = -static_cast<int>(random.below(6));
    lists.start(exponent);
    std::vector<Model> models(4);
    const auto value = [&] { return 20 * random.unit() - 10; };
    for (std::uint64_t step = random.below(60); step > 0; --step) {
      Model &model = models[random.below(models.size())], &other = models[random.below(models.size())];
      switch (random.below(6)) {
        case 0: {  // a cut at any value
          if (&model == &other || !other.buckets.empty()) break;
          const double at = value();
          const std::int64_t divided = bucket_index(at, exponent);
          other.list = lists.take_above(model.list, -10, at, 10);
          std::uint64_t above = 0;
          lists.drain(other.list, [&](const BucketSum& bucket) {
            ASSERT_GE(bucket.index, divided);
            if (bucket.index == divided) above = bucket.count;
            other.add(bucket);
          });
          for (const auto& [index, bucket] : other.buckets) {
            lists.append(other.list, bucket);
            BucketSum& whole = model.buckets.at(index);
            ASSERT_TRUE(index == divided || same(bucket, whole));
            whole.count -= bucket.count;
            for (std::size_t k = 0; k < 3; ++k) whole.sum[k] -= bucket.sum[k];
          }
          // In proportion to the value, to the nearest vertex.
          if (const auto at_cut = model.buckets.find(divided); at_cut != model.buckets.end()) {
            const double least = std::max(-10.0, std::ldexp(static_cast<double>(divided), exponent));
            const double most = std::min(10.0, std::ldexp(static_cast<double>(divided + 1), exponent));
            const double all = static_cast<double>(at_cut->second.count + above);
            ASSERT_NEAR(static_cast<double>(above), all * (most - at) / (most - least), 0.5 + 1e-6 * all);
          }
          std::erase_if(model.buckets, [](const auto& entry) { return entry.second.count == 0; });
          break;
        }
        case 1:
          if (&model == &other) break;
          lists.merge(model.list, other.list);
          model.add_all(other);
          break;
        case 2:
          if (random.chance(80)) break;
          ++exponent;
          lists.raise_exponent(exponent);
          for (Model& each : models) each.coarsen(1);
          break;
        case 3:
          if (&model == &other || model.buckets.empty() || other.buckets.empty() ||
              model.buckets.rbegin()->first > other.buckets.begin()->first)
            break;
          lists.concatenate(model.list, other.list);
          model.add_all(other);
          break;
        default: {
          const double at = value();
          const Point position = random_point(random);
          lists.add_vertex(model.list, at, position);
          BucketSum vertex{bucket_index(at, exponent), 0, {}};
          vertex.add(position);
          model.add(vertex);
        }
      }
    }
    for (Model& model : models) {
      auto expected = model.buckets.begin();
      lists.drain(model.list, [&](const BucketSum& bucket) {
        ASSERT_NE(expected, model.buckets.end());
        ASSERT_TRUE(same(bucket, expected->second)) << "bucket " << bucket.index;
        ++expected;
      });
      ASSERT_EQ(expected, model.buckets.end());
      ASSERT_TRUE(model.list.empty());
    }
  }
}

}  // namespace
}  // namespace reeb::test
