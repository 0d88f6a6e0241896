// Bucket sums against plain sums: they are exact, so that the order of additions does not show. Lists of buckets
// against maps (docs/SEMANTICS.md, Buckets).
#include "libreeb/graph/bucket_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

bool same(const BucketSum& a, const BucketSum& b) { return a.index == b.index && a.count == b.count && a.sum == b.sum; }

// A coordinate of any magnitude and sign, also beyond the limit of the sums.
Point random_point(Random& random) {
  Point point;
  for (double& x : point) x = std::ldexp(random.unit() - 0.5, static_cast<int>(random.below(120)) - 60);
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

TEST(BucketSum, KnowsTheSpreadAndTheRim) {
  Random random(base_seed());
  for (int i = 0; i < 200; ++i) {
    std::vector<Point> points(2 + random.below(60));
    const double far = i % 2 == 0 ? 0 : 1e6;  // beyond the small coordinates
    const bool ties = i % 4 < 2;              // few places, so that x and y often do not tell which is greater
    const auto coordinate = [&] { return ties ? static_cast<double>(random.below(3)) - 1 : random.unit(); };
    for (Point& point : points) point = {coordinate() + far, 2 * coordinate(), 3 * coordinate() - far};
    BucketSum parts[2];
    for (const Point& point : points) parts[random.below(2)].add(point);
    parts[0].add(parts[1]);
    const Bucket bucket = parts[0].mean();
    double squares = 0;
    for (const Point& point : points)
      for (std::size_t k = 0; k < 3; ++k) squares += (point[k] - bucket.mean[k]) * (point[k] - bucket.mean[k]);
    EXPECT_NEAR(bucket.spread, squares / static_cast<double>(points.size()), far == 0 ? 1e-6 : 1e-2);
    EXPECT_EQ(bucket.rim, rim_of(*std::ranges::max_element(points, {}, [](const Point& p) { return rim_of(p); })));
  }
}

TEST(BucketSum, HasARimWithoutSignsOfZero) {
  const Point points[] = {{-1e-60, 0, -0.0}, {0, 1, 0}, {-0.0, 1, -0.0}};  // -0 in single precision
  for (std::size_t first = 0; first < 3; ++first) {
    BucketSum sum;
    for (std::size_t i = 0; i < 3; ++i) sum.add(points[(first + i) % 3]);
    EXPECT_EQ(sum.rim, (RimPoint{0, 1, 0}));
    for (const float x : sum.rim) EXPECT_FALSE(std::signbit(x));
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
  const double small = std::nextafter(0x1p18, 0);  // the greatest that takes the short way
  EXPECT_EQ(mean(small), small);
  EXPECT_EQ(mean(-small), -small);
  BucketSum half;
  half.add(Point{0x1p17, -0x1p17, 0x1p17});
  EXPECT_EQ(half.mean().mean, (std::array<double, 3>{0x1p17, -0x1p17, 0x1p17}));
  EXPECT_EQ(mean(unit / 2), 0);
  EXPECT_EQ(mean(1 + unit * 1.5), 1 + unit);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(mean(2 * most), most);
  EXPECT_EQ(mean(infinity), most);
  EXPECT_EQ(mean(-1e308), -most);
  EXPECT_EQ(mean(std::numeric_limits<double>::quiet_NaN()), -most);
}

TEST(BucketSum, HoldsAsManyOfTheGreatestAsThereAreVertices) {
  BucketSum one, sum;
  one.add(Point{0x1p50, -0x1p50, 0});
  for (int bit = 0; bit < 32; ++bit) {
    sum.add(BucketSum(sum));
    sum.add(one);
  }
  EXPECT_EQ(sum.count, ~std::uint32_t{0});
  EXPECT_EQ(sum.mean().mean, (std::array<double, 3>{0x1p50, -0x1p50, 0}));
}

BucketSum many(std::int64_t index, std::uint32_t count) { return {.index = index, .count = count}; }

void expect_full(const std::function<void()>& add) {
  try {
    add();
    ADD_FAILURE() << "a count was wrong";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kResource);
    EXPECT_NE(error.hint().find("--buckets"), std::string::npos) << error.hint();
  }
}

TEST(BucketSum, RefusesMoreVerticesThanItCanCount) {
  constexpr std::uint32_t kMost = ~std::uint32_t{0};
  BucketSum sum = many(0, 3'000'000'000u);
  expect_full([&] { sum.add(many(0, 3'000'000'000u)); });
  EXPECT_EQ(sum.count, 3'000'000'000u);
  sum.add(many(0, kMost - 3'000'000'000u));
  EXPECT_EQ(sum.count, kMost);
  BucketSum divided = many(0, 10);
  expect_full([&] { divided.keep(9, sum); });
}

TEST(BucketLists, RefuseMoreVerticesThanABucketCanCount) {
  constexpr std::uint32_t kMost = ~std::uint32_t{0};
  BucketLists pool;
  pool.start(0);
  BucketLists::List list, upper;
  pool.add(list, many(0, kMost - 1));
  pool.add_vertex(list, 0.5, {});
  expect_full([&] { pool.add_vertex(list, 0.5, {}); });
  expect_full([&] { pool.add(list, many(0, 1)); });
  std::swap(list, upper);
  expect_full([&] { pool.concatenate(list, 0.5, {}, upper); });
}

// The expected content of a list: buckets of the pool's exponent, by index.
struct Model {
  std::map<std::int64_t, BucketSum> buckets;

  void add(const BucketSum& bucket) {
    const auto at = buckets.try_emplace(bucket.index, BucketSum{.index = bucket.index}).first;
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

// Any sequence of the operations that the engine does on lists, against maps.
class ManyLists {
 public:
  // In half of the cases there are so few buckets that most lists have at most one.
  explicit ManyLists(std::uint64_t seed)
      : random_(seed),
        few_(random_.chance(50)),
        exponent_((few_ ? 4 : 0) - static_cast<int>(random_.below(few_ ? 3 : 6))) {
    pool_.start(exponent_);
    if (!few_) sweep();
    for (std::uint64_t steps = random_.below(60); steps > 0; --steps) step();
  }

  void check() {
    for (std::size_t i = 0; i < kLists; ++i) {
      auto expected = models_[i].buckets.begin();
      const auto end = models_[i].buckets.end();
      std::vector<Bucket> means;
      pool_.visit(lists_[i], [&](const BucketSum& bucket) {
        ASSERT_NE(expected, end);
        ASSERT_TRUE(same(bucket, expected->second)) << "bucket " << bucket.index;
        ++expected;
        means.push_back(bucket.mean());
      });
      ASSERT_EQ(expected, end);
      ASSERT_EQ(drained(lists_[i], i % 2 == 0), means);
      ASSERT_TRUE(lists_[i].empty());
    }
    ASSERT_EQ(pool_.used(), 0u);
  }

 private:
  // The means, by either way to take them out.
  std::vector<Bucket> drained(BucketLists::List& list, bool packs) {
    std::vector<Bucket> means;
    ArcLists lists;
    if (packs) {
      pool_.drain_means(list, lists);
      lists.view().unpack(0, means);
    } else {
      pool_.drain(list, [&](const BucketSum& bucket) { means.push_back(bucket.mean()); });
    }
    return means;
  }

  static constexpr std::size_t kLists = 4;
  static constexpr double kMaxValue = 10;  // values are from -kMaxValue to kMaxValue

  double value() { return kMaxValue * (2 * random_.unit() - 1); }

  // The buckets that a sweep makes: ascending by index, at most one of each index in a list.
  void sweep() {
    std::vector<BucketSum> made;
    std::vector<std::size_t> list_of;
    for (std::int64_t index = -20; index < 20; index += 1 + static_cast<std::int64_t>(random_.below(3)))
      for (std::size_t i = 0; i < kLists; ++i) {
        if (random_.chance(50)) continue;
        made.push_back({.index = index});
        list_of.push_back(i);
        for (std::uint64_t n = 1 + random_.below(6); n > 0; --n) made.back().add(random_point(random_));
        models_[i].add(made.back());
      }
    std::ranges::copy(made, pool_.make(made.size()).begin());
    for (std::uint32_t b = 0; b < made.size(); ++b) pool_.link(lists_[list_of[b]], b);
  }

  void step() {
    const std::size_t i = random_.below(kLists), j = random_.below(kLists);
    switch (random_.below(6)) {
      case 0:
        return i != j ? cut(i, j) : void();
      case 1:
        if (i == j) return;
        pool_.merge(lists_[i], lists_[j]);
        return models_[i].add_all(models_[j]);
      case 2:
        if (random_.chance(80)) return;
        pool_.raise_exponent(++exponent_, [&](const auto& visit) { std::ranges::for_each(lists_, visit); });
        for (Model& model : models_) model.coarsen(1);
        return;
      case 3:
        return i != j ? concatenate(i, j) : void();
      default:
        return add_vertex(i);
    }
  }

  BucketSum vertex(double at, const Point& position) const {
    BucketSum sum{.index = bucket_index(at, exponent_)};
    sum.add(position);
    return sum;
  }

  void add_vertex(std::size_t i) {
    const double at = value();
    const Point position = random_point(random_);
    pool_.add_vertex(lists_[i], at, position);
    models_[i].add(vertex(at, position));
  }

  void concatenate(std::size_t i, std::size_t j) {
    auto &lower = models_[i].buckets, &upper = models_[j].buckets;
    if (!lower.empty() && !upper.empty() && lower.rbegin()->first > upper.begin()->first) return;
    const double at = value();
    const std::int64_t index = bucket_index(at, exponent_);
    if ((!lower.empty() && lower.rbegin()->first > index) || (!upper.empty() && upper.begin()->first < index)) {
      pool_.concatenate(lists_[i], lists_[j]);
    } else {
      const Point position = random_point(random_);
      pool_.concatenate(lists_[i], at, position, lists_[j]);
      models_[i].add(vertex(at, position));
    }
    models_[i].add_all(models_[j]);
  }

  // Moves what is above the cut from list i to list j, which has nothing below the cut. If the bucket that is cut has
  // four vertices or more, it is divided in proportion; otherwise it goes whole to the side of its greater part.
  void cut(std::size_t i, std::size_t j) {
    const double at = value();
    const std::int64_t divided = bucket_index(at, exponent_);
    auto &from = models_[i].buckets, &into = models_[j].buckets;
    if (!into.empty() && into.begin()->first < divided) return;
    if (into.empty() && random_.chance(50))
      lists_[j] = pool_.take_above(lists_[i], -kMaxValue, at, kMaxValue);
    else
      pool_.move_above(lists_[i], -kMaxValue, at, kMaxValue, lists_[j]);
    if (const auto bucket = from.find(divided); bucket != from.end()) {
      const std::uint64_t count = bucket->second.count, above = count_above(at, divided, count);
      if (above == count) {
        models_[j].add(bucket->second);
        from.erase(bucket);
      } else if (above != 0) {
        models_[j].add(divide(bucket->second, count - above));
      }
    }
    for (auto bucket = from.upper_bound(divided); bucket != from.end(); bucket = from.erase(bucket))
      models_[j].add(bucket->second);
  }

  std::uint64_t count_above(double at, std::int64_t divided, std::uint64_t count) const {
    const double begin = std::max(-kMaxValue, std::ldexp(static_cast<double>(divided), exponent_));
    const double end = std::min(kMaxValue, std::ldexp(static_cast<double>(divided + 1), exponent_));
    if (count < 4) return end - at > at - begin ? count : 0;
    return static_cast<std::uint64_t>(std::nearbyint((end - at) / (end - begin) * static_cast<double>(count)));
  }

  // Leaves this number of vertices in the bucket, with their share of the sum. Returns the others.
  static BucketSum divide(BucketSum& bucket, std::uint64_t left) {
    BucketSum rest = bucket;
    const double share = static_cast<double>(left) / static_cast<double>(bucket.count);
    for (std::size_t k = 0; k < 3; ++k) {
      bucket.sum[k] = static_cast<Int128>(static_cast<double>(bucket.sum[k]) * share);
      rest.sum[k] -= bucket.sum[k];
    }
    bucket.count = static_cast<std::uint32_t>(left);
    rest.count -= static_cast<std::uint32_t>(left);
    return rest;
  }

  Random random_;
  bool few_;
  int exponent_;
  BucketLists pool_;
  std::array<BucketLists::List, kLists> lists_{};
  std::array<Model, kLists> models_;
};

TEST(BucketLists, HoldWhatMapsHold) {
  const std::uint64_t seed = base_seed(), cases = case_count(2000);
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "case " << i);
    ManyLists(seed + i).check();
  }
}

}  // namespace
}  // namespace reeb::test
