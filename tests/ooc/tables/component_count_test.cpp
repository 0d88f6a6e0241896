#include "ooc/tables/component_count.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

using Edges = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

std::uint64_t joined(std::uint64_t nodes, const Edges& edges, const io::TempDir& temp, MemoryBudget& budget) {
  ComponentCount count(nodes, &temp, &budget);
  for (const auto& [lo, hi] : edges) count.add(lo, hi);
  return count.joined();
}

// `degree` edges per node, to nodes at a distance of at most `reach`.
Edges random_edges(std::uint64_t nodes, double degree, std::uint64_t reach, std::mt19937_64& random) {
  Edges edges;
  for (auto left = static_cast<std::uint64_t>(degree * static_cast<double>(nodes)); left > 0; --left) {
    const std::uint64_t hi = 1 + random() % (nodes - 1);
    edges.emplace_back(hi - 1 - random() % std::min(hi, reach), hi);
  }
  return edges;
}

TEST(ComponentCount, IsTheSameInMemoryAndInFiles) {
  constexpr std::uint64_t kNodes = 100'000, kLittle = 350'000;
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  std::mt19937_64 random(7);
  for (const double degree : {0.2, 0.5, 1.0, 2.5})
    for (const std::uint64_t reach : {std::uint64_t{3}, std::uint64_t{20'000}, kNodes}) {
      const Edges edges = random_edges(kNodes, degree, reach, random);
      MemoryBudget unlimited, little(kLittle);
      const std::uint64_t expected = joined(kNodes, edges, temp, unlimited);
      EXPECT_EQ(joined(kNodes, edges, temp, little), expected) << degree << " edges a node, reach " << reach;
      EXPECT_LE(little.peak_bytes(), kLittle);
      EXPECT_EQ(little.used_bytes(), 0u);
    }
}

TEST(ComponentCount, KnowsPathsStarsAndNothing) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  constexpr std::uint64_t kNodes = 200'000;
  Edges path, star;
  for (std::uint64_t i = 1; i < kNodes; ++i) {
    path.emplace_back(i - 1, i);
    star.emplace_back(0, i);
    star.emplace_back(i / 2, i);
  }
  for (const std::uint64_t limit : {MemoryBudget::kUnlimited, std::uint64_t{600'000}}) {
    MemoryBudget budget(limit);
    EXPECT_EQ(joined(kNodes, path, temp, budget), kNodes - 1);
    EXPECT_EQ(joined(kNodes, star, temp, budget), kNodes - 1);
    EXPECT_EQ(joined(kNodes, {}, temp, budget), 0u);
    EXPECT_EQ(joined(0, {}, temp, budget), 0u);
    EXPECT_EQ(joined(1, {}, temp, budget), 0u);
  }
}

TEST(ComponentCount, ReportsAFullDisk) {
  expect_failing_writes_are_reported([](const io::TempDir& temp, MemoryBudget& budget) {
    std::mt19937_64 random(1);
    const Reservation held = budget.reserve("others", MemoryBudget::kUnlimited - 350'000);
    joined(100'000, random_edges(100'000, 1.0, 100'000, random), temp, budget);
  });
}

}  // namespace
}  // namespace reeb::ooc
