#include "ooc/stored_hierarchy/paged_rows.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <stdexcept>

#include "tests/support/scratch.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

struct Place {
  std::uint64_t begin = 3;
  std::array<std::uint32_t, 4> more{1, 2, 3, 4};
  friend bool operator==(const Place&, const Place&) = default;
};

// Random operations compared with maps, while rows are dropped from time to time.
void compare_with_maps(std::uint64_t allowance, std::uint64_t seed) {
  SCOPED_TRACE(testing::Message() << "allowance " << allowance << " seed " << seed);
  constexpr std::uint32_t kRows = 60'000;
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  {
    PagedRows rows(temp, budget, kRows, sizeof(Place) + 2 * sizeof(std::uint32_t), allowance);
    const auto places = rows.add_column(Place{});
    const auto numbers = rows.add_column(std::uint32_t{77});
    std::map<std::uint32_t, Place> expected_places;
    std::map<std::uint32_t, std::uint32_t> expected_numbers, expected_late;
    std::vector<std::uint32_t> ids(kRows);
    for (std::uint32_t id = 0; id < kRows; ++id) ids[id] = id;
    std::mt19937_64 random(seed);
    rows.change(numbers, 5) = expected_numbers[5] = 9;
    const auto late = rows.add_column(std::uint32_t{0});  // after the first entry was set

    const auto get = [](const auto& map, std::uint32_t id, const auto& fill) {
      return map.contains(id) ? map.at(id) : fill;
    };
    for (int round = 0; round < 5; ++round) {
      for (int step = 0; step < 30'000; ++step) {
        const std::uint32_t id = ids[random() % ids.size()];
        const auto value = static_cast<std::uint32_t>(random());
        switch (random() % 6) {
          case 0:
            rows.change(places, id) = expected_places[id] = {value, {value, 0, 1, value}};
            break;
          case 1:
            rows.change(numbers, id) = expected_numbers[id] = value;
            break;
          case 2:
            rows.change(late, id) = expected_late[id] = value;
            break;
          default:
            ASSERT_EQ(rows.get(places, id), get(expected_places, id, Place{}));
            ASSERT_EQ(rows.get(numbers, id), get(expected_numbers, id, 77u));
            ASSERT_EQ(rows.get(late, id), get(expected_late, id, 0u));
        }
      }
      // Drops by what a column says, as cancelling does.
      std::vector<std::uint32_t> left;
      rows.keep_if([&](std::uint32_t id) {
        EXPECT_EQ(rows.get(late, id), get(expected_late, id, 0u));
        if (rows.get(late, id) % 4 == 1 || id % 7 == random() % 7) return false;
        left.push_back(id);
        return true;
      });
      const std::size_t before = ids.size();
      ids = left;
      ASSERT_LT(ids.size(), before);
      ASSERT_EQ(rows.count(), ids.size());
      for (std::uint32_t id = 0, next = 0; id < kRows; ++id) {
        if (next < ids.size() && ids[next] == id) {
          ++next;
          ASSERT_EQ(rows.get(places, id), get(expected_places, id, Place{}));
          continue;
        }
        ASSERT_EQ(rows.get(places, id), Place{}) << "a row that was dropped";
        ASSERT_EQ(rows.get(numbers, id), 77u);
        ASSERT_THROW(rows.change(numbers, id), std::logic_error);
      }
    }
    rows.set_all(numbers, 4u);
    for (const std::uint32_t id : ids) ASSERT_EQ(rows.get(numbers, id), 4u);
    ASSERT_GT(rows.pages().spilled_bytes(), 0u) << "nothing spilled";
    EXPECT_LE(rows.pages().resident_bytes(), std::max(allowance, PagedRows::kLeastBytes));
    EXPECT_GE(budget.used_bytes(), rows.pages().resident_bytes() + KeptIds::bytes_for(kRows));
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
}

TEST(PagedRows, AgreeWithMapsWhileTheySpillAndAreDropped) {
  const std::uint64_t base = test::base_seed();
  for (std::uint64_t i = 0; i < 4; ++i) compare_with_maps(i * (256 << 10), base + i);
}

TEST(PagedRows, WhatIsLeftFitsInMemoryAndIsReadOnce) {
  constexpr std::uint32_t kRows = 400'000;
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  PagedRows rows(temp, budget, kRows, sizeof(std::uint64_t), 1 << 20);
  const auto column = rows.add_column(std::uint64_t{0});
  for (std::uint32_t id = 0; id < kRows; ++id) rows.change(column, id) = id;
  EXPECT_FALSE(rows.fits_in_memory());
  rows.keep_if([](std::uint32_t id) { return id % 4 == 0; });
  EXPECT_TRUE(rows.fits_in_memory());
  const auto pass_over_all = [&] {
    for (std::uint32_t id = 0; id < kRows; id += 4) ASSERT_EQ(rows.get(column, id), id);
  };
  pass_over_all();
  const std::uint64_t before = rows.pages().refetches();
  pass_over_all();
  EXPECT_EQ(rows.pages().refetches(), before);
}

TEST(PagedRows, RefusesAColumnThatDoesNotFit) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  PagedRows rows(temp, budget, 100, 8, 0);
  rows.add_column(std::uint32_t{0});
  EXPECT_THROW(rows.add_column(Place{}), std::logic_error);
  const auto column = rows.add_column(std::uint32_t{0});
  rows.change(column, 3) = 1;
  EXPECT_THROW(rows.add_column(std::uint32_t{1}), std::logic_error) << "no room, and too late for a fill value";
}

}  // namespace
}  // namespace reeb::ooc
