// Loops on a torus, and none on a disc.
#include "libreeb/repair/nearby_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libreeb/base/vector3.h"

namespace reeb::test {
namespace {

constexpr double kTurn = 2 * 3.14159265358979;

// `around` vertices along the large circle of radius 10, `across` along the small one of radius 2.
EditablePatch torus(std::uint32_t around, std::uint32_t across) {
  EditablePatch patch;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = kTurn * i / around, w = kTurn * j / across, r = 10 + 2 * std::cos(w);
      patch.add_vertex(
          {VertexId(i * across + j), {r * std::cos(u), r * std::sin(u), 2 * std::sin(w)}, true, false, {}});
    }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * across + j % across; };
  std::uint64_t id = 0;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      patch.add_triangle({at(i, j), at(i + 1, j), at(i + 1, j + 1)}, id++);
      patch.add_triangle({at(i, j), at(i + 1, j + 1), at(i, j + 1)}, id++);
    }
  return patch;
}

double length_of(const EditablePatch& patch, const std::vector<std::uint32_t>& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += distance(patch.position(loop[i]), patch.position(loop[(i + 1) % loop.size()]));
  return sum;
}

TEST(NearbyLoop, IsTheShortestOnATorus) {
  EditablePatch patch = torus(40, 8);
  const double small = 8 * 4 * std::sin(kTurn / 16);
  for (const std::uint32_t v : {0u, 5u, 133u}) {
    const std::vector<std::uint32_t> near = {v};
    const auto loop = nearby_loop(patch, near, 20);
    ASSERT_EQ(loop.size(), 8u);
    EXPECT_NEAR(length_of(patch, loop), small, 1e-9);
    for (std::size_t i = 0; i < loop.size(); ++i) EXPECT_TRUE(patch.has_edge(loop[i], loop[(i + 1) % loop.size()]));
    EXPECT_EQ(std::ranges::count(loop, v), 1);
    EXPECT_TRUE(nearby_loop(patch, near, small - 0.01).empty());
  }
}

// A ring of triangles is away: what is left is a tube, on which the small circle divides.
TEST(NearbyLoop, IsNoneThatDivides) {
  EditablePatch patch = torus(40, 8);
  for (std::uint32_t t = 0; t < 16; ++t) patch.remove(t);
  const std::vector<std::uint32_t> near = {100, 104};
  EXPECT_TRUE(nearby_loop(patch, near, 50).empty());
  EditablePatch whole = torus(40, 8);
  EXPECT_EQ(nearby_loop(whole, near, 50).size(), 8u);
}

}  // namespace
}  // namespace reeb::test
