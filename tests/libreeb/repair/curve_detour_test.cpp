// Curves on a grid from which triangles were removed.
#include "libreeb/repair/curve_detour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace reeb::test {
namespace {

constexpr std::uint32_t kSide = 12;

std::uint32_t at(std::uint32_t x, std::uint32_t y) { return x + kSide * y; }

EditablePatch grid() {
  EditablePatch patch;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x)
      patch.add_vertex({VertexId(at(x, y)), {static_cast<double>(x), static_cast<double>(y), 0}, true, false, {}});
  std::uint64_t id = 0;
  for (std::uint32_t y = 0; y + 1 < kSide; ++y)
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      patch.add_triangle({at(x, y), at(x + 1, y), at(x + 1, y + 1)}, id++);
      patch.add_triangle({at(x, y), at(x + 1, y + 1), at(x, y + 1)}, id++);
    }
  return patch;
}

void remove_at(EditablePatch& patch, std::uint32_t v) {
  for (const std::uint32_t t : std::vector<std::uint32_t>(patch.all_at(v).begin(), patch.all_at(v).end()))
    patch.remove(t);
}

// Around the square from (2, 2) to (9, 9).
std::vector<std::uint32_t> square() {
  std::vector<std::uint32_t> path;
  for (std::uint32_t i = 2; i < 9; ++i) path.push_back(at(i, 2));
  for (std::uint32_t i = 2; i < 9; ++i) path.push_back(at(9, i));
  for (std::uint32_t i = 9; i > 2; --i) path.push_back(at(i, 9));
  for (std::uint32_t i = 9; i > 2; --i) path.push_back(at(2, i));
  return path;
}

TEST(CurveDetour, GoesAroundWhatIsRemoved) {
  EditablePatch patch = grid();
  EXPECT_EQ(with_detours(patch, square()), square());
  remove_at(patch, at(5, 2));
  remove_at(patch, at(9, 9));
  const std::vector<std::uint32_t> path = with_detours(patch, square());
  ASSERT_GT(path.size(), 20u);
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_TRUE(patch.has_edge(path[i], path[(i + 1) % path.size()])) << i;
  for (const std::uint32_t v : square())
    EXPECT_EQ(std::ranges::count(path, v), v == at(5, 2) || v == at(9, 9) ? 0 : 1) << v;
  std::vector<std::uint32_t> sorted = path;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

TEST(CurveDetour, GivesUpIfTheWayIsLong) {
  EditablePatch patch = grid();
  for (std::uint32_t y = 0; y < kSide; ++y) remove_at(patch, at(6, y));
  EXPECT_TRUE(with_detours(patch, square()).empty());
}

}  // namespace
}  // namespace reeb::test
