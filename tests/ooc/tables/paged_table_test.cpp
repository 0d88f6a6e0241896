#include "ooc/tables/paged_table.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <map>
#include <optional>
#include <random>

#include "libreeb/base/error.h"
#include "libreeb/base/ids.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

struct Point3f {
  std::array<float, 3> at{};
  friend bool operator==(const Point3f&, const Point3f&) = default;
};

template <class T>
T value_of(std::uint64_t number) {
  if constexpr (std::is_same_v<T, Point3f>)
    return {{static_cast<float>(number % 1000), 1.0f, static_cast<float>(number % 7)}};
  else
    return static_cast<T>(number);
}

// Random operations compared with a map, at indices that jump between near and far.
template <class T>
void compare_with_map(std::uint64_t allowance, std::uint64_t seed, std::optional<T> usual = {}) {
  SCOPED_TRACE(testing::Message() << "allowance " << allowance << " seed " << seed);
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(1 << 20);
  {
    const T fill = value_of<T>(77);
    PagedTable<T> table("table", temp, budget, allowance, fill);
    if constexpr (std::has_single_bit(sizeof(T)))
      if (usual) table = PagedTable<T>("table", temp, budget, allowance, fill, *usual);
    std::map<std::uint64_t, T> model;
    const auto expected = [&](std::uint64_t i) { return model.contains(i) ? model[i] : fill; };
    std::mt19937_64 random(seed);
    std::uint64_t near = 0;
    for (int step = 0; step < 20'000; ++step) {
      if (step % 20 == 0) near = random() % 500'000;
      const std::uint64_t i = near + random() % 3000;
      const T value = usual && step % 3 == 0 ? *usual : value_of<T>(random());
      switch (random() % 6) {
        case 0:
          table.set(i, value), model[i] = value;
          break;
        case 1:
          table.change(i) = value, model[i] = value;
          break;
        case 2: {
          std::array<T, 40> values;
          for (std::size_t k = 0; k < values.size(); ++k) values[k] = value_of<T>(random()), model[i + k] = values[k];
          table.write(i, values);
          break;
        }
        case 3: {
          std::array<T, 300> values;
          table.read(i, values);
          for (std::size_t k = 0; k < values.size(); ++k) ASSERT_EQ(values[k], expected(i + k));
          break;
        }
        case 4: {  // some twice, and some on another page
          std::array<VertexId, 40> ids;
          for (VertexId& id : ids) id = VertexId(near + random() % 3000);
          std::size_t next = 0;
          table.change_each(std::span<const VertexId>(ids), [&](std::size_t k, T& entry) {
            ASSERT_EQ(k, next++);
            ASSERT_EQ(entry, expected(ids[k].value()));
            entry = model[ids[k].value()] = value_of<T>(random());
          });
          ASSERT_EQ(next, ids.size());
          break;
        }
        default:
          ASSERT_EQ(table.get(i), expected(i));
      }
    }
    for (const auto& [i, value] : model) ASSERT_EQ(table.get(i), value);
    ASSERT_GT(table.pages().spilled_bytes(), 0u) << "nothing spilled";
    EXPECT_LE(table.pages().resident_bytes(), std::max<std::uint64_t>(allowance, 4 * 65536));
    EXPECT_GE(budget.used_bytes(), table.pages().resident_bytes());
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
  EXPECT_TRUE(scratch.empty());
}

TEST(PagedTable, AgreesWithAMapWhileItSpills) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    compare_with_map<std::uint32_t>(0, seed);
    compare_with_map<double>(512 << 10, seed);
    compare_with_map<Point3f>(5 * 65536, seed);
    compare_with_map<std::uint32_t>(0, seed, 77);
    compare_with_map<double>(512 << 10, seed, 0.0);
  }
}

TEST(PagedTable, IsPlainMemoryWhileItFits) {
  const Scratch scratch;
  const FaultAtCall writes(io::FileCall::kWrite);
  const io::ScopedFileFaults faults(writes);
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  PagedTable<std::uint32_t> table("table", temp, budget, 8 << 20, 0u);
  for (std::uint32_t i = 0; i < 1'000'000; ++i) table.set(i, i * 3);
  for (std::uint32_t i = 0; i < 1'000'000; ++i) ASSERT_EQ(table.get(i), i * 3);
  EXPECT_EQ(writes.count(), 0u);
  EXPECT_EQ(table.pages().spilled_bytes(), 0u);
}

// A page that was never in the file, and one that was.
// order.
TEST(PagedTable, PagesOfTheUsualValueAreNotWritten) {
  constexpr std::uint64_t kEntries = 500 * 1024;
  const Scratch scratch;
  const FaultAtCall writes(io::FileCall::kWrite);
  const io::ScopedFileFaults faults(writes);
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  PagedTable<std::uint32_t> table("table", temp, budget, 0, 0u, 7u);
  for (std::uint64_t i = 0; i < kEntries; ++i) table.set(i, 7);
  EXPECT_EQ(writes.count(), 0u);
  EXPECT_GT(table.next_unusual(0, kEntries), 100'000u);
  EXPECT_LT(table.next_unusual(0, kEntries), kEntries) << "what is in memory may differ";
  for (std::uint64_t i = 0; i < kEntries; ++i) ASSERT_EQ(table.get(i), 7u);
  EXPECT_EQ(writes.count(), 0u) << "a usual page was read, and is still usual";

  const auto pass_over_all = [&] {
    for (std::uint64_t i = 0; i < kEntries; i += 500) table.get(i);
  };
  table.set(5000, 8);
  pass_over_all();
  EXPECT_EQ(table.pages().spilled_bytes(), PageCache::kPageBytes);
  EXPECT_EQ(table.next_unusual(0, kEntries), 5000u / 1024 * 1024);
  ASSERT_EQ(table.get(5000), 8u);
  table.set(5000, 7);
  pass_over_all();
  EXPECT_EQ(table.pages().spilled_bytes(), PageCache::kPageBytes);
  EXPECT_GT(table.next_unusual(0, kEntries), 100'000u);
  for (std::uint64_t i = 0; i < kEntries; ++i) ASSERT_EQ(table.get(i), 7u);
}

// Pages that follow each other are written in one call. None of them is written again unless it changes again.
TEST(PagedTable, PagesInARowAreWrittenOnce) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(1 << 20);
  PagedTable<std::uint32_t> table("table", temp, budget, 0, 0);
  constexpr std::uint64_t kPerPage = PageCache::kPageBytes / sizeof(std::uint32_t), kPages = 1000;
  for (std::uint64_t i = 0; i < kPages * kPerPage; ++i) table.set(i, static_cast<std::uint32_t>(3 * i + 1));
  EXPECT_LE(table.pages().spilled_bytes(), kPages * PageCache::kPageBytes);
  EXPECT_GE(table.pages().spilled_bytes(), (kPages - PageCache::kRequiredFrames) * PageCache::kPageBytes);
  for (std::uint64_t page = 0; page < kPages; page += 3) table.set(page * kPerPage + page % kPerPage, 7);
  for (std::uint64_t i = 0; i < kPages * kPerPage; ++i) {
    const std::uint64_t page = i / kPerPage;
    const bool changed = page % 3 == 0 && i % kPerPage == page % kPerPage;
    ASSERT_EQ(table.get(i), changed ? 7 : static_cast<std::uint32_t>(3 * i + 1)) << i;
  }
}

TEST(PagedTable, ReadingWhatWasNeverSetWritesNothing) {
  const Scratch scratch;
  const FaultAtCall writes(io::FileCall::kWrite);
  const io::ScopedFileFaults faults(writes);
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  PagedTable<std::uint64_t> table("table", temp, budget, 0, 42u);
  for (std::uint64_t i = 0; i < 1'000'000; i += 1000) ASSERT_EQ(table.get(i), 42u);
  EXPECT_EQ(writes.count(), 0u);
}

TEST(PagedTable, SpillsWhenTheBudgetNotTheAllowanceIsUsedUp) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(1 << 20);
  const Reservation other = budget.reserve("other", 600 << 10);
  PagedTable<std::uint64_t> table("table", temp, budget, MemoryBudget::kUnlimited, 0u);
  for (std::uint64_t i = 0; i < 400'000; ++i) table.set(i, i);
  for (std::uint64_t i = 0; i < 400'000; ++i) ASSERT_EQ(table.get(i), i);
  EXPECT_LE(budget.peak_bytes(), budget.limit_bytes());
}

TEST(PagedTable, SaysWhenNotEvenTheLeastFits) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(100 << 10);
  PagedTable<std::uint64_t> table("last uses", temp, budget, 1 << 20, 0u);
  try {
    for (std::uint64_t i = 0; i < 400'000; ++i) table.set(i, i);
    FAIL() << "the limit was overrun";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kResource);
    EXPECT_NE(e.message().find("last uses"), std::string::npos);
  }
}

TEST(PagedTable, EachFailingWriteIsReported) {
  expect_failing_writes_are_reported([](const io::TempDir& temp, MemoryBudget& budget) {
    PagedTable<std::uint64_t> table("table", temp, budget, 0, 0u);
    for (std::uint64_t i = 0; i < 100'000; ++i) table.set(i * 17 % 100'000, i);
  });
}

}  // namespace
}  // namespace reeb::ooc
