// Ranks against std::sort, for values that are spread evenly, in clusters, and tied.
#include "libreeb/sweep/vertex_ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

void expect_sorted(const std::vector<double>& values, test::Random& random) {
  std::vector<VertexId> ids;
  for (std::uint64_t i = 0; i < values.size(); ++i) ids.emplace_back(i);
  random.shuffle(ids);
  std::vector<std::uint32_t> expected(values.size());
  std::iota(expected.begin(), expected.end(), 0u);
  std::sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : ids[a] < ids[b];
  });
  VertexRanks ranks;
  ranks.sort(values, ids);
  EXPECT_TRUE(std::ranges::equal(ranks.order(), expected)) << values.size() << " values";
}

TEST(VertexRanks, AreThoseOfTheTotalOrder) {
  test::Random random(test::base_seed());
  for (const std::size_t n : {0u, 1u, 2u, 3u, 7u, 100u, 5000u}) {
    std::vector<double> even(n), ties(n), clusters(n), huge(n), equal(n, 4.5);
    for (std::size_t i = 0; i < n; ++i) {
      even[i] = static_cast<double>(random.below(1'000'000'000)) / 7;
      ties[i] = static_cast<double>(random.below(20));
      // All but one are in the first and the last bucket.
      clusters[i] = i == 0 ? 1e9 : static_cast<double>(random.below(1000)) / 1e3 + (i % 2 == 0 ? 0 : 2e9);
      huge[i] = (static_cast<double>(random.below(2'000'001)) / 1e6 - 1) * 1.7e308;
    }
    for (const auto& values : {even, ties, clusters, huge, equal}) expect_sorted(values, random);
  }
}

}  // namespace
}  // namespace reeb
