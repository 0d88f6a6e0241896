// Chunks of an indexed mesh, with a limit of their vertices.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/last_use.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kBlock = 16, kMostVertices = 100;
constexpr ChunkSize kSize{.first = 128, .most = 1024, .patch = 128, .most_vertices = kMostVertices};

// The first half of the triangles in order, then the rest shuffled: few and many vertices a triangle.
ModelMesh half_shuffled_grid() {
  const ModelMesh grid = grid_mesh(60, 40);
  std::vector<std::size_t> order(grid.corners.size() / 3);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2), order.end(), std::mt19937(3));
  ModelMesh mesh{grid.columns, {}};
  for (const std::size_t t : order)
    for (std::size_t k = 0; k < 3; ++k) mesh.corners.push_back(grid.corners[3 * t + k]);
  return mesh;
}

std::vector<WorkItem> chunks_from(const ModelMesh& model, const ChunkPlace& start) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  ModelIndexedMesh mesh(model);
  auto uses = scan_last_use(mesh, temp, budget, {.block_triangles = kBlock});
  FunctionValues functions({}, 3);
  const auto source = chunks_of(mesh, *uses, functions, kSize, start);
  std::vector<WorkItem> chunks;
  for (WorkItem item; source->next(item);) chunks.push_back(item);
  return chunks;
}

TEST(IndexedChunks, EndWhenTheyHaveManyVertices) {
  const ModelMesh mesh = half_shuffled_grid();
  const std::vector<WorkItem> chunks = chunks_from(mesh, {});
  constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> first(mesh.vertex_count(), kNever), last(mesh.vertex_count(), 0);
  std::size_t corner = 0, ended_early = 0;
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const Chunk& chunk = chunks[c].chunk;
    EXPECT_LE(chunk.vertex_count(), kMostVertices + 3 * kBlock);
    ended_early += chunk.vertex_count() > kMostVertices ? 1u : 0u;
    for (const std::uint32_t local : chunk.corners) {
      const VertexId v = chunk.ids[local];
      ASSERT_EQ(v, mesh.corners[corner++]);
      first[v.value()] = std::min(first[v.value()], c);
      last[v.value()] = c;
    }
    EXPECT_EQ(chunks[c].end.triangles, corner / 3);
    EXPECT_TRUE(corner == mesh.corners.size() || corner / 3 % kBlock == 0);
  }
  EXPECT_EQ(corner, mesh.corners.size());
  EXPECT_GT(ended_early, chunks.size() / 2);
  for (std::size_t c = 0; c < chunks.size(); ++c)
    for (std::size_t i = 0; i < chunks[c].chunk.vertex_count(); ++i) {
      const auto v = chunks[c].chunk.ids[i].value();
      ASSERT_EQ(int{chunks[c].chunk.uses[i]}, (first[v] < c ? kUsedEarlier : 0) | (last[v] > c ? kUsedLater : 0));
    }
}

TEST(IndexedChunks, AreTheSameFromEveryPlace) {
  const ModelMesh mesh = half_shuffled_grid();
  const std::vector<WorkItem> all = chunks_from(mesh, {});
  for (std::size_t c = 0; c + 1 < all.size(); ++c) {
    const std::vector<WorkItem> rest = chunks_from(mesh, all[c].end);
    ASSERT_EQ(rest.size(), all.size() - c - 1);
    for (std::size_t r = 0; r < rest.size(); ++r) {
      ASSERT_EQ(rest[r].chunk.ids, all[c + 1 + r].chunk.ids);
      ASSERT_EQ(rest[r].chunk.uses, all[c + 1 + r].chunk.uses);
    }
  }
}

}  // namespace
}  // namespace reeb::ooc
