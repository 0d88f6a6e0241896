#include "ooc/sorting/rank_sort.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "tests/support/same.h"

namespace reeb::ooc {
namespace {

struct Record {
  std::uint64_t rank, rest;
  friend auto operator<=>(const Record&, const Record&) = default;
};

using MakeRank = std::function<std::uint64_t(std::uint64_t random, std::uint64_t index)>;

// Expects the order of std::sort, in one thread and in several.
void compare(const char* what, const MakeRank& make_rank) {
  SCOPED_TRACE(what);
  std::mt19937_64 random(7);
  for (const std::size_t count : {0u, 1u, 2u, 16u, 17u, 100u, 5000u, 60000u})
    for (const unsigned threads : {1u, 3u}) {
      SCOPED_TRACE(testing::Message() << count << " records, threads " << threads);
      std::vector<Record> records(count);
      for (std::size_t i = 0; i < count; ++i) records[i] = {make_rank(random(), i), random() % 1000};
      std::vector<Record> expected = records;
      std::sort(expected.begin(), expected.end());
      sort_by_rank(
          std::span(records), [](const Record& r) { return r.rank; }, std::less<Record>(), threads);
      EXPECT_TRUE(test::same(records, expected));
    }
}

TEST(RankSort, GivesTheOrderOfComparing) {
  compare("spread", [](std::uint64_t random, std::uint64_t) { return random; });
  compare("equal", [](std::uint64_t, std::uint64_t) { return 42; });
  compare("two ranks", [](std::uint64_t random, std::uint64_t) { return random % 2 << 63; });
  compare("few bits", [](std::uint64_t random, std::uint64_t) { return random % 13 << 30; });
  compare("ascending", [](std::uint64_t, std::uint64_t index) { return index; });
  compare("descending", [](std::uint64_t, std::uint64_t index) { return ~index; });
  compare("the ends of the range", [](std::uint64_t random, std::uint64_t) {
    return random % 3 == 0 ? random % 5 : std::numeric_limits<std::uint64_t>::max() - random % 5;
  });
}

// Each division leaves nearly all records in one part.
TEST(RankSort, RanksThatAreSpreadUnevenly) {
  compare("powers of two", [](std::uint64_t random, std::uint64_t) { return std::uint64_t{1} << random % 64; });
  compare("short and long", [](std::uint64_t random, std::uint64_t) { return random >> random % 64; });
}

}  // namespace
}  // namespace reeb::ooc
