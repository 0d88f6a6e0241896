#include "ooc/whole_mesh/reorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include "libreeb/base/error.h"
#include "ooc/chunks/last_use.h"
#include "ooc/whole_mesh/hilbert.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

using Triangle = std::array<std::uint64_t, 3>;

Triangle turned(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::vector<Triangle> triangles_of(std::span<const VertexId> corners) {
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < corners.size(); t += 3)
    triangles.push_back(turned({corners[t].value(), corners[t + 1].value(), corners[t + 2].value()}));
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Expects the reordered mesh to be the original one under to_original(), vertex by vertex and triangle by triangle.
void expect_same(const ModelMesh& model, ReorderedMesh& mesh) {
  ASSERT_EQ(mesh.vertex_count(), model.vertex_count());
  std::vector<VertexId> ids, originals(model.vertex_count());
  for (std::uint64_t v = 0; v < model.vertex_count(); ++v) ids.emplace_back(v);
  originals = ids;
  mesh.to_original(originals);
  EXPECT_EQ(std::set<VertexId>(originals.begin(), originals.end()).size(), ids.size());
  std::vector<double> values(ids.size());
  for (unsigned k = 0; k < model.columns.size(); ++k) {
    mesh.gather(ids, std::array{k}, values);
    for (std::size_t i = 0; i < ids.size(); ++i) ASSERT_EQ(values[i], model.columns[k][originals[i].value()]);
  }
  std::vector<VertexId> corners, some;
  mesh.rewind();
  while (mesh.read(some, 1000))
    for (const VertexId v : some) corners.push_back(originals[v.value()]);
  EXPECT_EQ(triangles_of(corners), triangles_of(model.corners));
}

// The triangles of a mesh, as it delivers them, under their original ids.
std::vector<VertexId> corners_of(ReorderedMesh& mesh) {
  std::vector<VertexId> corners = all_corners(mesh, 1000);
  mesh.to_original(corners);
  return corners;
}

void compare(const ModelMesh& model, std::uint64_t allowance, std::uint64_t limit) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(limit);
  for (const bool in_slabs : {false, true}) {
    SCOPED_TRACE(in_slabs);
    std::vector<VertexId> of_one_thread;
    for (const unsigned threads : {1u, 2u}) {
      SCOPED_TRACE(threads);
      ModelIndexedMesh indexed(model);
      const LastUseOptions blocks{.block_triangles = 64};
      const auto [mesh, uses] = reorder_with_last_uses(
          indexed, temp, budget, {.allowance_bytes = allowance, .threads = threads, .in_slabs = in_slabs}, blocks);
      expect_same(model, *mesh);
      EXPECT_EQ(uses.summary(), scan_last_use(*mesh, temp, budget, blocks)->summary());
      if (threads == 1) of_one_thread = corners_of(*mesh);
      EXPECT_EQ(corners_of(*mesh), of_one_thread);
    }
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
  EXPECT_TRUE(scratch.empty());
}

TEST(Reorder, KeepsTheMeshUnderItsOriginalIds) {
  compare(shuffled(grid_mesh(60, 50), 1), 32 << 20, 64 << 20);
  compare(shuffled(grid_mesh(250, 200), 2), 256 << 10, 8 << 20);  // many slices, many runs
  compare(shuffled(grid_mesh(500, 400), 3), 8 << 20, 16 << 20);   // a few, which two threads can hold
}

TEST(Reorder, OddMeshes) {
  ModelMesh mesh = grid_mesh(9, 8);
  mesh.columns.emplace_back(mesh.vertex_count() + 1, 0.1);                                 // a property
  for (int k = 0; k < 3; ++k) mesh.columns[static_cast<std::size_t>(k)].push_back(1e308);  // unused
  for (const std::uint64_t v : {5u, 5u, 7u, 9u, 9u, 9u, 4u, 3u, 4u}) mesh.corners.emplace_back(v);
  compare(mesh, 0, 8 << 20);
  compare({std::vector<std::vector<double>>(3), {}}, 1 << 20, 8 << 20);
  compare({std::vector<std::vector<double>>(3, {1.0, 1.0, 1.0}), {VertexId(2), VertexId(0), VertexId(1)}}, 1 << 20,
          8 << 20);
}

// Columns of float32 values take another way than others, and so do columns after the third.
TEST(Reorder, ColumnsOfAnyKind) {
  for (std::size_t columns = 1; columns <= 4; ++columns)
    for (std::size_t wide = 0; wide <= columns; ++wide) {
      SCOPED_TRACE(testing::Message() << columns << " columns, number " << wide << " is wide");
      ModelMesh mesh = shuffled(grid_mesh(100, 90), columns);
      mesh.columns.resize(columns, mesh.columns[0]);
      for (auto& column : mesh.columns)
        for (double& value : column) value = double{static_cast<float>(value)};
      mesh.columns[0][5] = std::numeric_limits<float>::max();
      if (wide < columns) mesh.columns[wide][7777] = columns % 2 == 0 ? 0.1 : -1e300;
      compare(mesh, 8 << 20, 16 << 20);
    }
}

// Of which more meet in a vertex than can be sorted in memory, and of which most are the same.
TEST(Reorder, TrianglesOfFewVertices) {
  constexpr std::uint64_t kRim = 120'000;
  ModelMesh fan{std::vector<std::vector<double>>(3, {0.0}), {}};  // the first on the curve
  for (std::uint64_t v = 1; v <= kRim + 1; ++v) {
    const double turn = static_cast<double>(v) / kRim * 1.5;
    fan.columns[0].push_back(std::cos(turn));
    fan.columns[1].push_back(std::sin(turn));
    fan.columns[2].push_back(0);
    if (v <= kRim)
      for (const std::uint64_t corner : {std::uint64_t{0}, v, v + 1}) fan.corners.emplace_back(corner);
  }
  compare(shuffled(fan, 1), 8 << 20, 16 << 20);
  ModelMesh same{std::vector<std::vector<double>>(3, {1.0, 2.0, 3.0, 4.0}), {}};
  for (int t = 0; t < 150'000; ++t)
    for (const int corner : {t % 2, 3, 2}) same.corners.emplace_back(static_cast<std::uint64_t>(corner));
  compare(same, 8 << 20, 16 << 20);
}

TEST(Reorder, MakesTheFrontSmall) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  const ModelMesh model = shuffled(grid_mesh(300, 300), 3);
  ModelIndexedMesh before(model);
  const LastUseOptions blocks{.block_triangles = 256};
  const auto mesh = reorder(before, temp, budget);
  const auto live_before = scan_last_use(before, temp, budget, blocks)->summary().max_live_vertices;
  const auto live_after = scan_last_use(*mesh, temp, budget, blocks)->summary().max_live_vertices;
  EXPECT_GT(live_before, 50'000u);
  EXPECT_LT(live_after, 3000u) << "a square patch of n vertices has a border of about 4 sqrt(n)";
}

TEST(Reorder, SlabsOfALongMeshHaveAShorterFront) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  const ModelMesh model = shuffled(grid_mesh(2000, 100), 4);
  const auto front = [&](bool in_slabs) {
    ModelIndexedMesh indexed(model);
    const auto mesh = reorder(indexed, temp, budget, {.in_slabs = in_slabs});
    return scan_last_use(*mesh, temp, budget, {.block_triangles = 256})->summary().max_live_vertices;
  };
  const auto of_slabs = front(true), of_one_curve = front(false);
  EXPECT_LT(of_slabs, of_one_curve);
  EXPECT_LT(of_slabs, 1000u) << "the border of a slab is across the mesh, of about 100 vertices";
}

TEST(Reorder, EachFailingWriteIsReported) {
  const ModelMesh model = shuffled(grid_mesh(120, 120), 5);
  expect_failing_writes_are_reported([&](const io::TempDir& temp, MemoryBudget& budget) {
    ModelIndexedMesh indexed(model);
    reorder(indexed, temp, budget, {.allowance_bytes = 64 << 10});
  });
  expect_failing_writes_are_reported([&](const io::TempDir& temp, MemoryBudget& budget) {
    ModelIndexedMesh indexed(model);
    reorder(indexed, temp, budget, {.allowance_bytes = 8 << 20, .threads = 2});
  });
}

// Fails in one of the two threads that reorder it.
class FailingMesh : public ModelIndexedMesh {
 public:
  FailingMesh(const ModelMesh& model, int gathers, int reads)
      : ModelIndexedMesh(model), gathers_(gathers), reads_(reads) {}
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    if (gathers_-- == 0) throw Error(ErrorKind::kBadInput, "a vertex", "");
    ModelIndexedMesh::gather(ids, columns, values);
  }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    if (reads_-- == 0) throw Error(ErrorKind::kBadInput, "a triangle", "");
    return ModelIndexedMesh::read(corners, limit);
  }

 private:
  int gathers_, reads_;
};

TEST(Reorder, AnErrorInEitherThreadEndsBoth) {
  ModelMesh model = shuffled(grid_mesh(200, 200), 6);
  model.columns[0][9] = 0.1;  // not a float32: the column is looked up once more
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  const auto error_of = [&](int gathers, int reads, int polls) -> std::string {
    FailingMesh mesh(model, gathers, reads);
    const auto progress = [&](double) {
      if (polls-- == 0) throw Error(ErrorKind::kBadInput, "a stop", "");
    };
    try {
      reorder(mesh, temp, budget, {.threads = 2, .progress = progress});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of(-1, -1, -1), "");
  for (int n = 0; n < 30; ++n) {
    SCOPED_TRACE(n);
    EXPECT_NE(error_of(n, -1, -1).find("a vertex"), std::string::npos);
    EXPECT_NE(error_of(-1, n % 20, -1).find("a triangle"), std::string::npos);
    EXPECT_NE(error_of(-1, -1, n).find("a stop"), std::string::npos);
    EXPECT_EQ(budget.used_bytes(), 0u);
  }
  EXPECT_TRUE(scratch.empty());
}

// Cells of 2^shift to a side: the curve visits neighbours in turn.
void expect_curve_of_neighbours(unsigned shift) {
  constexpr std::uint32_t kSide = 16;
  std::vector<std::array<std::uint32_t, 3>> by_index(kSide * kSide * kSide);
  for (std::uint32_t x = 0; x < kSide; ++x)
    for (std::uint32_t y = 0; y < kSide; ++y)
      for (std::uint32_t z = 0; z < kSide; ++z) {
        const std::uint64_t index = hilbert_index({x << shift, y << shift, z << shift}) >> (3 * shift);
        ASSERT_LT(index, by_index.size());
        by_index[index] = {x, y, z};
      }
  for (std::size_t i = 1; i < by_index.size(); ++i) {
    int distance = 0;
    for (std::size_t a = 0; a < 3; ++a)
      distance += std::abs(static_cast<int>(by_index[i][a]) - static_cast<int>(by_index[i - 1][a]));
    ASSERT_EQ(distance, 1) << "at " << i;
  }
}

TEST(Hilbert, ManyCellsAtATime) {
  std::array<std::array<std::uint32_t, 64>, 3> cells;
  for (std::uint32_t i = 0; i < 64; ++i)
    for (std::uint32_t a = 0; a < 3; ++a) cells[a][i] = (i * 3 + a + 1) * 2654435761u >> (32 - kHilbertBits);
  const auto indices = hilbert_indices<64>(cells);
  for (std::size_t i = 0; i < 64; ++i)
    EXPECT_EQ(indices[i], hilbert_index({cells[0][i], cells[1][i], cells[2][i]})) << i;
}

TEST(Hilbert, NeighboursOnTheCurveShareAFace) {
  for (const unsigned shift : {0u, 9u, kHilbertBits - 4}) {
    SCOPED_TRACE(shift);
    expect_curve_of_neighbours(shift);
  }
}

}  // namespace
}  // namespace reeb::ooc
