#include "ooc/chunks/last_use.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <span>

#include "libreeb/base/error.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

struct Model {
  std::vector<std::int64_t> first, last;  // block by vertex, -1 if unused
  std::uint64_t max_live = 0, unused = 0, degenerate = 0;
};

Model model_of(const ModelMesh& mesh, std::uint64_t block_triangles) {
  Model model;
  model.first.assign(mesh.vertex_count(), -1);
  model.last = model.first;
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    const auto v = mesh.corners[c].value();
    const auto block = static_cast<std::int64_t>(c / 3 / block_triangles);
    if (model.first[v] < 0) model.first[v] = block;
    model.last[v] = block;
  }
  const auto blocks = static_cast<std::int64_t>((mesh.corners.size() / 3 + block_triangles - 1) / block_triangles);
  for (std::int64_t b = 0; b < blocks; ++b) {
    std::uint64_t live = 0;
    for (std::size_t v = 0; v < model.first.size(); ++v)
      live += model.first[v] >= 0 && model.first[v] <= b && model.last[v] > b;
    model.max_live = std::max(model.max_live, live);
  }
  model.unused = static_cast<std::uint64_t>(std::count(model.first.begin(), model.first.end(), -1));
  for (std::size_t t = 0; t < mesh.corners.size(); t += 3) {
    const auto* c = &mesh.corners[t];
    model.degenerate += c[0] == c[1] || c[1] == c[2] || c[0] == c[2];
  }
  return model;
}

ModelMesh random_mesh(std::uint64_t vertices, std::uint64_t triangles, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  ModelMesh mesh{std::vector<std::vector<double>>(3, std::vector<double>(vertices)), {}};
  for (std::uint64_t c = 0; c < 3 * triangles; ++c) mesh.corners.push_back(VertexId(random() % vertices));
  return mesh;
}

void compare_once(const ModelMesh& mesh, const LastUseOptions& options, const io::TempDir& temp) {
  ModelIndexedMesh indexed(mesh);
  MemoryBudget budget(4 << 20);
  {
    auto uses = scan_last_use(indexed, temp, budget, options);
    ASSERT_TRUE(uses.has_value());
    const UseSummary& s = uses->summary();
    const Model model = model_of(mesh, s.block_triangles);
    EXPECT_LE(s.block_count, options.most_blocks);
    EXPECT_EQ(s.triangle_count, mesh.corners.size() / 3);
    EXPECT_EQ(s.block_count, (s.triangle_count + s.block_triangles - 1) / s.block_triangles);
    EXPECT_EQ(s.vertex_count, mesh.vertex_count());
    EXPECT_EQ(s.degenerate_triangles, model.degenerate);
    EXPECT_EQ(s.unused_vertices, model.unused);
    EXPECT_EQ(s.max_live_vertices, model.max_live);
    EXPECT_LE(s.live_profile.size(), 256u);
    if (s.block_count > 0) {
      EXPECT_EQ(*std::max_element(s.live_profile.begin(), s.live_profile.end()), model.max_live);
    }

    std::vector<VertexId> ids;
    for (std::uint64_t v = mesh.vertex_count(); v-- > 0;) ids.push_back(VertexId(v));
    std::vector<std::uint32_t> entries(ids.size());
    uses->lookup(ids, entries);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::uint64_t v = ids[i].value();
      const UseEntry entry(entries[i]);
      ASSERT_EQ(entry.unused(), model.first[v] < 0) << v;
      if (entry.unused()) continue;
      ASSERT_EQ(entry.last_block(), model.last[v]) << v;
      const std::int64_t span = model.last[v] - model.first[v];
      // Joining blocks can leave a span unknown that would be known if blocks had been larger from the start.
      if (entry.span() != UseEntry::kSaturatedSpan) {
        ASSERT_EQ(entry.span(), span) << v;
      }
      if (s.block_triangles == options.block_triangles) {
        ASSERT_EQ(entry.span(), std::min<std::int64_t>(span, 4095)) << v;
      }
    }
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
}

void compare(const ModelMesh& mesh, LastUseOptions options, const io::TempDir& temp) {
  for (options.threads = 1; options.threads <= 2; ++options.threads) {
    SCOPED_TRACE(testing::Message() << "threads " << options.threads);
    compare_once(mesh, options, temp);
  }
}

TEST(LastUse, AgreesWithTheDefinition) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  compare(grid_mesh(40, 30), {.block_triangles = 64}, temp);
  compare(shuffled(grid_mesh(40, 30), 5), {.block_triangles = 10}, temp);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    compare(random_mesh(1 + seed * 7, seed * 13, seed), {.block_triangles = 1 + seed % 9}, temp);
  }
}

TEST(LastUse, EmptyAndTriangleFreeMeshes) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  compare(random_mesh(0, 0, 1), {}, temp);
  compare(random_mesh(100, 0, 1), {}, temp);
}

TEST(LastUse, LongSpansSaturate) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  compare(random_mesh(50, 9000, 3), {.block_triangles = 1}, temp);
}

TEST(LastUse, JoinsBlocksWhenTheyAreTooMany) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  for (std::uint32_t most : {2u, 6u, 7u, 64u})
    compare(random_mesh(300, 1001, most), {.block_triangles = 3, .most_blocks = most}, temp);
  compare(random_mesh(60, 20'000, 9), {.block_triangles = 1, .most_blocks = 6000}, temp);
}

TEST(LastUse, TheTableMaySpill) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  const ModelMesh mesh = random_mesh(200'000, 4000, 2);
  compare(mesh, {.block_triangles = 512, .allowance_bytes = 0}, temp);
  ModelIndexedMesh indexed(mesh);
  MemoryBudget budget;
  const auto uses = scan_last_use(indexed, temp, budget, {.allowance_bytes = 0});
  EXPECT_GT(uses->spilled_bytes(), 0u);
}

TEST(LastUse, GivesUpOnAnIncoherentMeshOnly) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  const ModelMesh rows = grid_mesh(500, 300);
  const ModelMesh random = shuffled(rows, 2);
  for (const auto& [mesh, incoherent] : {std::pair(&rows, false), std::pair(&random, true)}) {
    ModelIndexedMesh indexed(*mesh);
    MemoryBudget budget;
    const auto uses = scan_last_use(indexed, temp, budget, {.allowance_bytes = 0, .give_up_when_incoherent = true});
    EXPECT_EQ(uses.has_value(), !incoherent);
  }
}

// A mesh that tells how many triangles it has.
class CountedMesh : public ModelIndexedMesh {
 public:
  explicit CountedMesh(const ModelMesh& mesh) : ModelIndexedMesh(mesh), triangles_(mesh.corners.size() / 3) {}
  std::optional<std::uint64_t> triangles_by_size() const override { return triangles_; }

 private:
  std::uint64_t triangles_;
};

// The share of a mesh after which it is known that more than 2000 vertices are live; 1 if they are not.
double read_until_too_many(const ModelMesh& mesh) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  CountedMesh indexed(mesh);
  const auto uses = scan_last_use(indexed, temp, budget, {.block_triangles = 256, .most_live_vertices = 2000});
  EXPECT_EQ(uses.has_value(), indexed.bytes_read() == indexed.bytes_total());
  return static_cast<double>(indexed.bytes_read()) / static_cast<double>(indexed.bytes_total());
}

TEST(LastUse, SeesEarlyThatTrianglesAreScattered) {
  EXPECT_LT(read_until_too_many(shuffled(grid_mesh(300, 300), 5)), 0.05);
  EXPECT_EQ(read_until_too_many(grid_mesh(300, 300)), 1);
  // Triangles without common vertices, of which none is live.
  ModelMesh loose{std::vector<std::vector<double>>(3, std::vector<double>(90'000)), {}};
  for (std::uint64_t v = 0; v < loose.vertex_count(); ++v) loose.corners.emplace_back(v);
  EXPECT_EQ(read_until_too_many(loose), 1);
}

// The scan of triangles that come in batches of any size is that of the mesh.
TEST(LastUse, TrianglesCanComeInBatches) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  std::mt19937_64 random(5);
  for (const std::uint64_t triangles : {0u, 1u, 4000u}) {
    const ModelMesh mesh = random_mesh(300, triangles, triangles);
    ModelIndexedMesh indexed(mesh);
    const LastUseOptions options{.block_triangles = 7, .most_blocks = 64};
    auto whole = scan_last_use(indexed, temp, budget, options);
    LastUseScan scan(mesh.vertex_count(), 0, temp, budget, options);
    for (std::span<const VertexId> left = mesh.corners; !left.empty();) {
      const auto some = left.first(std::min<std::size_t>(left.size(), 3 * (random() % 40)));
      scan.look_at(some);
      scan.use(some);
      left = left.subspan(some.size());
    }
    LastUse found = scan.finish();
    EXPECT_EQ(found.summary(), whole->summary());
    for (std::uint64_t v = 0; v < mesh.vertex_count(); ++v) {
      std::array<std::uint32_t, 1> entry, expected;
      found.read(VertexId(v), entry);
      whole->read(VertexId(v), expected);
      ASSERT_EQ(entry, expected) << v;
    }
  }
}

TEST(LastUse, EachFailingWriteIsReported) {
  const ModelMesh mesh = random_mesh(200'000, 1000, 2);
  expect_failing_writes_are_reported([&](const io::TempDir& temp, MemoryBudget& budget) {
    ModelIndexedMesh indexed(mesh);
    scan_last_use(indexed, temp, budget, {.allowance_bytes = 0});
  });
}

}  // namespace
}  // namespace reeb::ooc
