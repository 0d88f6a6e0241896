#include "ooc/whole_mesh/mesh_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ooc/chunks/last_use.h"
#include "ooc/whole_mesh/piece_order.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

// With edges of length 1/4.
ModelMesh flat_grid(std::uint64_t columns, std::uint64_t rows) {
  ModelMesh mesh = grid_mesh(columns, rows);
  std::ranges::fill(mesh.columns[2], 0);
  return mesh;
}

// The largest number of vertices that triangles use both up to the end of a block and after it.
std::uint64_t front_of(std::span<const VertexId> corners, std::uint64_t vertices, std::uint64_t block_triangles) {
  std::vector<std::int64_t> first(vertices, -1), last(vertices, -1);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const auto v = corners[c].value();
    last[v] = static_cast<std::int64_t>(c / 3 / block_triangles);
    if (first[v] < 0) first[v] = last[v];
  }
  std::uint64_t most = 0;
  for (std::int64_t b = 0; b <= static_cast<std::int64_t>(corners.size() / 3 / block_triangles); ++b) {
    std::uint64_t live = 0;
    for (std::size_t v = 0; v < vertices; ++v) live += first[v] >= 0 && first[v] <= b && last[v] > b;
    most = std::max(most, live);
  }
  return most;
}

TEST(MeshPieces, CoverTheMeshInItsOrder) {
  MemoryBudget budget;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const std::uint64_t columns = 150 + 7 * seed, side = 2 * seed;
    const ModelMesh model = in_random_tiles(flat_grid(columns, 200), columns, side, seed);
    ModelIndexedMesh mesh(model);
    const auto most = static_cast<std::uint32_t>(seed % 3 == 0 ? 100 : 4096);
    const auto cut = cut_into_pieces(mesh, budget, {.most_triangles = most});
    ASSERT_TRUE(cut.has_value() || side * side * 2 < 24);
    if (!cut) continue;
    std::vector<VertexId> corners, some;
    for (const MeshPiece& piece : cut->pieces) {
      EXPECT_LE(piece.triangles, most);
      EXPECT_EQ(piece.place.first, corners.size());
      mesh.seek(piece.place);
      ASSERT_TRUE(mesh.read(some, piece.triangles));
      corners.insert(corners.end(), some.begin(), some.end());
    }
    EXPECT_EQ(corners, model.corners);
    EXPECT_GE(cut->memory.bytes(), cut->pieces.size() * sizeof(MeshPiece));
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
}

// The tiles are cut where the next one is 4 away: 16 edges.
TEST(MeshPieces, EndWhereTheNextTriangleIsFar) {
  constexpr std::uint64_t kColumns = 1001, kSide = 20;
  const ModelMesh model = in_random_tiles(flat_grid(kColumns, 401), kColumns, kSide, 3);
  ModelIndexedMesh mesh(model);
  MemoryBudget budget;
  const auto cut = cut_into_pieces(mesh, budget, {.most_triangles = 1 << 20});
  ASSERT_TRUE(cut.has_value());
  std::set<std::uint64_t> cuts;
  for (const MeshPiece& piece : cut->pieces) cuts.insert(piece.place.first / 3);
  const auto at = [&](std::size_t t, std::size_t axis) { return model.columns[axis][model.corners[3 * t].value()]; };
  std::size_t far = 0, odd = 0;
  for (std::size_t t = 1; t < model.corners.size() / 3; ++t) {
    const double step = std::max(std::abs(at(t, 0) - at(t - 1, 0)), std::abs(at(t, 1) - at(t - 1, 1)));
    if (step > 4 + kSide / 4.0) {
      EXPECT_TRUE(cuts.contains(t)) << t;
      ++far;
    } else if (step < 1) {
      odd += cuts.contains(t);
    }
  }
  EXPECT_LE(odd, 5u) << "in pieces of neighbouring tiles, which get too large";
  EXPECT_GT(far, 900u);
  EXPECT_LT(cuts.size(), 1100u) << "1,000 tiles";
}

// It is found out at once, without a pass.
TEST(MeshPieces, ThereAreNoneInARandomOrder) {
  const ModelMesh model = shuffled(flat_grid(400, 400), 1);
  ModelIndexedMesh mesh(model);
  MemoryBudget budget;
  EXPECT_FALSE(cut_into_pieces(mesh, budget).has_value());
  EXPECT_LT(mesh.bytes_read(), mesh.bytes_total() / 10);
  EXPECT_LT(mesh.looked_up(), 2000u) << "each can cost a read of the file";
  const ModelMesh tiles = in_random_tiles(flat_grid(400, 400), 400, 20, 1);
  ModelIndexedMesh many(tiles);
  EXPECT_TRUE(cut_into_pieces(many, budget).has_value());
  EXPECT_FALSE(cut_into_pieces(many, budget, {.most_pieces = 50}).has_value());
}

TEST(MeshPieces, OddMeshes) {
  MemoryBudget budget;
  ModelMesh empty{std::vector<std::vector<double>>(3), {}};
  ModelIndexedMesh none(empty);
  auto cut = cut_into_pieces(none, budget);
  ASSERT_TRUE(cut.has_value());
  EXPECT_TRUE(cut->pieces.empty());
  order_pieces(*cut);
  EXPECT_FALSE(cut_into_pieces(none, budget, {.coordinates = 0}).has_value());

  // All at one point, degenerate, and as far apart as numbers allow.
  for (const double place : {0.0, 1.0, 1e308}) {
    ModelMesh mesh = flat_grid(100, 100);
    for (auto& column : mesh.columns)
      for (std::size_t v = 0; v < column.size(); ++v) column[v] = v % 2 == 0 ? place : -place;
    for (std::size_t c = 0; c < 300; ++c) mesh.corners[c] = VertexId(0);
    ModelIndexedMesh indexed(mesh);
    auto odd = cut_into_pieces(indexed, budget);
    ASSERT_TRUE(odd.has_value());
    order_pieces(*odd);
    PiecewiseMesh piecewise(std::make_unique<ModelIndexedMesh>(mesh), std::move(*odd));
    EXPECT_EQ(all_corners(piecewise, 1000).size(), mesh.corners.size());
  }
}

TEST(PieceOrder, EachPieceOnceAndAFrontAsDefined) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  for (const std::uint64_t side : {5u, 8u, 16u}) {
    constexpr std::uint64_t kColumns = 401;
    const ModelMesh model = in_random_tiles(flat_grid(kColumns, 301), kColumns, side, side);
    auto indexed = std::make_unique<ModelIndexedMesh>(model);
    auto cut = cut_into_pieces(*indexed, budget);
    ASSERT_TRUE(cut.has_value());
    const auto by_place = [](const MeshPiece& piece) { return piece.place.first; };
    std::vector<MeshPiece> before = cut->pieces;
    order_pieces(*cut);
    std::vector<MeshPiece> after = cut->pieces;
    std::ranges::sort(after, {}, by_place);
    EXPECT_TRUE(std::ranges::equal(before, after, {}, by_place, by_place));

    PiecewiseMesh mesh(std::move(indexed), std::move(*cut));
    const std::vector<VertexId> corners = all_corners(mesh, 1000);
    EXPECT_EQ(all_corners(mesh, 77), corners);
    EXPECT_EQ(mesh.bytes_read(), mesh.bytes_total());
    ASSERT_EQ(corners.size(), model.corners.size());
    for (const std::uint64_t block : {64u, 4096u}) {
      const auto front = scan_last_use(mesh, temp, budget, {.block_triangles = block})->summary().max_live_vertices;
      EXPECT_EQ(front, front_of(corners, model.vertex_count(), block));
      EXPECT_LT(front, 4 * 301u) << "a plane across the mesh cuts 301 edges along";
      EXPECT_GT(front_of(model.corners, model.vertex_count(), block), 5 * front);
    }
  }
}

// The front of strips is along the strips.
TEST(PieceOrder, StripsAreSweptAcross) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  constexpr std::uint64_t kColumns = 401;
  // Strips of half a row, the last first.
  const ModelMesh rows = flat_grid(kColumns, 301);
  ModelMesh model{rows.columns, {}};
  const std::size_t strip = 3 * (kColumns - 1);
  std::vector<std::size_t> strips(rows.corners.size() / strip);
  std::iota(strips.begin(), strips.end(), std::size_t{0});
  std::shuffle(strips.begin(), strips.end(), std::mt19937_64(5));
  for (const std::size_t s : strips)
    model.corners.insert(model.corners.end(), rows.corners.begin() + static_cast<std::ptrdiff_t>(s * strip),
                         rows.corners.begin() + static_cast<std::ptrdiff_t>((s + 1) * strip));
  auto indexed = std::make_unique<ModelIndexedMesh>(model);
  auto cut = cut_into_pieces(*indexed, budget);
  ASSERT_TRUE(cut.has_value());
  order_pieces(*cut);
  PiecewiseMesh mesh(std::move(indexed), std::move(*cut));
  // A few rows, where the order of the strips has a third of all vertices.
  EXPECT_LT(scan_last_use(mesh, temp, budget, {.block_triangles = 256})->summary().max_live_vertices, 6 * kColumns);
  EXPECT_GT(front_of(model.corners, model.vertex_count(), 256), 50'000u);
}

}  // namespace
}  // namespace reeb::ooc
