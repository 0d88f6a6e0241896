// RecyclingArray against a stack of free indices.
#include "libreeb/containers/recycling_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

struct Element {
  std::uint32_t link;
  std::uint32_t& next_free() { return link; }
};

struct Model {
  std::uint32_t take() {
    if (free.empty()) return size++;
    const std::uint32_t index = free.back();
    free.pop_back();
    return index;
  }
  std::vector<std::uint32_t> free;
  std::uint32_t size = 0;
};

// Takes and frees up to `most` elements at a time.
void play(std::uint64_t seed, std::uint64_t most) {
  test::Random random(seed);
  RecyclingArray<Element> array;
  Model model;
  std::vector<std::uint32_t> taken;
  for (int turn = 0; turn < 40; ++turn) {
    for (auto n = random.below(most); n > 0; --n) {
      taken.push_back(model.take());
      ASSERT_EQ(array.take(), taken.back()) << "seed " << seed << ", turn " << turn;
    }
    for (auto n = random.below(most); n > 0 && !taken.empty(); --n) {
      std::swap(taken[random.below(taken.size())], taken.back());
      array.free(taken.back());
      model.free.push_back(taken.back());
      taken.pop_back();
    }
    ASSERT_EQ(array.used(), taken.size());
    ASSERT_EQ(array.size(), model.size);
    if (turn % 8 == 0) {
      RecyclingArray<Element> copy = array;
      const std::vector<bool> is_free = copy.restored_free();
      for (const std::uint32_t index : model.free) ASSERT_TRUE(is_free[index]);
      ASSERT_EQ(static_cast<std::size_t>(std::count(is_free.begin(), is_free.end(), true)), model.free.size());
      array = copy;
    }
  }
}

TEST(RecyclingArray, TakesTheIndexThatWasFreedLast) {
  for (std::uint64_t seed = test::base_seed(); seed < test::base_seed() + 20; ++seed) play(seed, 1 + seed % 7 * 10);
}

TEST(RecyclingArray, TakesThemInOrderWhenVeryManyAreFree) {
  for (std::uint64_t seed = test::base_seed(); seed < test::base_seed() + 4; ++seed) play(seed, 20'000);
}

}  // namespace
}  // namespace reeb
