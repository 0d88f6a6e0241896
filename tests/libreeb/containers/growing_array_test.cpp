// GrowingArray against a vector.
#include "libreeb/containers/growing_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

TEST(GrowingArray, HoldsWhatAVectorHolds) {
  const auto same = [](const GrowingArray<int>& array, const std::vector<int>& vector) {
    return std::ranges::equal(array.all(), vector);
  };
  test::Random random(test::base_seed());
  GrowingArray<int> array;
  std::vector<int> model;
  std::size_t most = 0;
  for (int turn = 0; turn < 2000; ++turn) {
    const auto number = static_cast<int>(random.below(1000));
    if (random.below(200) == 0) {
      array.clear();
      model.clear();
    } else if (random.below(4) == 0) {
      const std::size_t first = model.size(), count = random.below(300);
      array.grow_by(count);
      std::fill_n(array.data() + first, count, number);
      model.insert(model.end(), count, number);
    } else {
      array.append(number);
      model.push_back(number);
    }
    most = std::max(most, model.size());
    ASSERT_TRUE(same(array, model)) << "turn " << turn;
    ASSERT_EQ(array.memory_bytes(), most * sizeof(int)) << "turn " << turn;
  }
  GrowingArray<int> copy = array;
  const GrowingArray<int> moved = std::move(array);
  EXPECT_TRUE(same(copy, model) && same(moved, model));
  copy.append(1);
  EXPECT_TRUE(same(moved, model));
}

TEST(GrowingArray, AppendsAnElementOfItsOwn) {
  GrowingArray<std::uint64_t> array;
  array.append(7);
  for (int i = 0; i < 1'000'000; ++i) array.append(array[array.size() / 2]);
  EXPECT_EQ(std::ranges::count(array.all(), 7u), 1'000'001);
}

}  // namespace
}  // namespace reeb
