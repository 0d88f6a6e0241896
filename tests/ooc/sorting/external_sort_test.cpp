#include "ooc/sorting/external_sort.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <random>

#include "libreeb/base/error.h"
#include "tests/support/same.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

struct Pair {
  std::uint64_t key, payload;
  friend auto operator<=>(const Pair&, const Pair&) = default;
};

std::vector<Pair> random_pairs(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Pair> pairs(count);
  for (Pair& pair : pairs) pair = {random() % (1 + count / 3), random()};
  return pairs;
}

std::vector<Pair> read_all(ExternalSort<Pair>& sort, std::size_t limit) {
  std::vector<Pair> all, some;
  while (sort.read(some, limit)) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void add_in_pieces(ExternalSort<Pair>& sort, std::span<const Pair> pairs) {
  for (std::size_t piece = 1; !pairs.empty(); piece = piece * 2 % 9973) {
    const std::size_t count = std::min(piece, pairs.size());
    sort.add(pairs.first(count));
    pairs = pairs.subspan(count);
  }
}

void compare(std::size_t count, SortOptions options, std::uint64_t limit_bytes, bool must_spill) {
  SCOPED_TRACE(testing::Message() << count << " records, allowance " << options.allowance_bytes << " background "
                                  << options.background);
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(limit_bytes);
  std::vector<Pair> expected = random_pairs(count, count);
  {
    ExternalSort<Pair> sort("pairs", temp, budget, options);
    add_in_pieces(sort, expected);
    sort.finish();
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(sort.size(), count);
    EXPECT_EQ(sort.spilled_bytes() > 0, must_spill);
    EXPECT_TRUE(test::same(read_all(sort, 1000), expected));
    sort.rewind();
    EXPECT_TRUE(test::same(read_all(sort, 7), expected));
    sort.set_aside();
    EXPECT_TRUE(!must_spill || budget.used_bytes() == 0);
    sort.rewind();
    EXPECT_TRUE(!must_spill || budget.used_bytes() > 0);
    EXPECT_TRUE(test::same(read_all(sort, 900), expected));
    EXPECT_LE(budget.peak_bytes(), limit_bytes);
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
  EXPECT_TRUE(scratch.empty());
}

TEST(ExternalSort, AgreesWithASortInMemory) {
  for (const bool background : {false, true})
    for (const unsigned threads : {1u, 3u}) {
      const auto with = [&](std::uint64_t allowance) {
        return SortOptions{.allowance_bytes = allowance, .threads = threads, .background = background};
      };
      compare(0, with(1 << 20), 8 << 20, false);
      compare(1, with(0), 8 << 20, false);
      compare(4096, with(0), 8 << 20, false);
      compare(5000, with(0), 8 << 20, true);
      compare(100'000, with(16 << 20), 32 << 20, false);
      compare(100'000, with(1 << 20), 8 << 20, true);
      compare(200'000, with(0), 512 << 10, true);         // many passes of two
      compare(200'000, with(16 << 20), 600 << 10, true);  // the budget, not the allowance
    }
}

// Compares, and notes how many threads do so at once.
struct CountingLess {
  static inline std::atomic<int> now = 0, most = 0;
  bool operator()(const Pair& a, const Pair& b) const {
    const int count = ++now;
    for (int before = most; before < count && !most.compare_exchange_weak(before, count);) {
    }
    --now;
    return a < b;
  }
};

TEST(ExternalSort, SortsInAsManyThreadsAsItMay) {
  for (const unsigned threads : {1u, 2u, 3u}) {
    const Scratch scratch;
    const io::TempDir temp(scratch.path());
    MemoryBudget budget;
    CountingLess::most = 0;
    ExternalSort<Pair, PlainCodec<Pair>, CountingLess> sort("pairs", temp, budget,
                                                            {.allowance_bytes = 64 << 20, .threads = threads});
    sort.add(random_pairs(1'000'000, 1));
    sort.finish();
    EXPECT_LE(CountingLess::most, static_cast<int>(threads));
    if (threads == 1) {
      EXPECT_EQ(CountingLess::most, 1);
    }
  }
}

// Merging holds a block of each run: a large file has fewer runs if they are longer.
TEST(ExternalSort, AnAllowanceThatGrowsLeavesLessToMerge) {
  constexpr std::size_t kCount = 1'000'000;
  std::vector<Pair> expected = random_pairs(kCount, 5);
  const auto peak_bytes = [&](std::uint64_t most_bytes) {
    const Scratch scratch;
    const io::TempDir temp(scratch.path());
    MemoryBudget budget;
    ExternalSort<Pair> sort("pairs", temp, budget, {.allowance_bytes = 64 << 10, .most_bytes = most_bytes});
    add_in_pieces(sort, random_pairs(kCount, 5));
    sort.finish(64 << 20);
    EXPECT_TRUE(test::same(read_all(sort, 1000), expected));
    return budget.peak_bytes();
  };
  std::sort(expected.begin(), expected.end());
  const std::uint64_t fixed = peak_bytes(0), growing = peak_bytes(4 << 20);
  EXPECT_GT(fixed, kCount * sizeof(Pair));  // 244 runs
  EXPECT_LT(growing, fixed / 3);
}

TEST(ExternalSort, SaysWhenNotEvenTheLeastFits) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(10 << 10);
  ExternalSort<Pair> sort("pairs", temp, budget);
  EXPECT_THROW(sort.add(Pair{1, 2}), Error);
}

TEST(ExternalSort, EachFailingWriteIsReported) {
  const auto pairs = random_pairs(60'000, 1);
  for (const bool background : {false, true})
    expect_failing_writes_are_reported([&](const io::TempDir& temp, MemoryBudget& budget) {
      ExternalSort<Pair> sort("pairs", temp, budget, {.allowance_bytes = 256 << 10, .background = background});
      add_in_pieces(sort, pairs);
      sort.finish();
    });
}

// The first caller that gets the error might ignore it, as a checkpoint that cannot be written does.
TEST(ExternalSort, DoesNotForgetThatRecordsWereLost) {
  struct Nowhere : StateWriter {
    void write(std::span<const std::byte>) override {}
  };
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  const std::vector<Pair> pairs = random_pairs(20'000, 1);
  ExternalSort<Pair> sort("pairs", temp, budget,
                          {.allowance_bytes = 256 << 10, .background = true, .file = scratch.path() + "/records"});
  const io::ScopedFileFaults full(FaultAtCall(io::FileCall::kWrite, 1, {.error = ENOSPC}));
  bool failed = false;
  for (std::size_t i = 0; !failed && i < pairs.size(); i += 100) {
    sort.add(std::span(pairs).subspan(i, 100));
    try {
      Nowhere out;
      sort.save(out);
    } catch (const Error&) {
      failed = true;
    }
  }
  ASSERT_TRUE(failed);
  Nowhere out;
  EXPECT_THROW(sort.save(out), Error);
  EXPECT_THROW(sort.finish(), Error);
}

}  // namespace
}  // namespace reeb::ooc
