#include "io/grids/grid_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <set>

#include "libreeb/base/error.h"
#include "tests/support/inputs/memory_grid.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Delivered {
  std::vector<std::uint64_t> vertices;
  std::set<std::vector<std::uint64_t>> simplices;
  std::vector<std::vector<double>> positions;
};

// Reads all, and checks that each event is legal where it comes.
Delivered deliver(MeshReader& reader, std::size_t batch_events) {
  Delivered all;
  std::set<std::uint64_t> active;
  for (MeshBatch batch; reader.read(batch);) {
    EXPECT_LE(batch.vertex_count + batch.simplex_count() + batch.finalized.size(), batch_events);
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      const std::uint64_t v = batch.first_vertex.value() + i;
      EXPECT_TRUE(all.vertices.empty() || all.vertices.back() < v);
      all.vertices.push_back(v);
      active.insert(v);
      all.positions.emplace_back();
      for (const auto& column : batch.coordinates) all.positions.back().push_back(column[i]);
    }
    batch.for_each_simplex([&](std::span<const VertexId> corners) {
      std::vector<std::uint64_t> simplex;
      for (const VertexId v : corners) {
        simplex.push_back(v.value());
        EXPECT_TRUE(active.contains(v.value()));
      }
      EXPECT_TRUE(std::is_sorted(simplex.begin(), simplex.end()));
      EXPECT_TRUE(all.simplices.insert(simplex).second) << "a simplex comes twice";
    });
    for (const VertexId v : batch.finalized) EXPECT_EQ(active.erase(v.value()), 1u);
  }
  EXPECT_TRUE(active.empty()) << "not finalized";
  return all;
}

TEST(GridMesh, DeliversTheSimplicesWhoseVerticesHaveValues) {
  const std::uint64_t seed = base_seed();
  for (std::uint64_t i = 0; i < case_count(2000); ++i) {
    Random random(seed + i);
    const GridShape shape = random_grid(random);
    std::vector<double> values = random_grid_values(shape, random);
    std::vector<bool> present(values.size(), true);
    const bool skips = random.chance(70);
    const auto missing = static_cast<unsigned>(random.below(60));
    std::vector<std::uint64_t> vertices;
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (skips && random.chance(missing)) {
        present[v] = false;
        values[v] = random.chance(50) ? kNan : -99;
      }
      if (present[v]) vertices.push_back(v);
    }
    auto grid = std::make_unique<MemoryGrid>(shape, values);
    grid->change_info().nodata = -99;
    ReadOptions options;
    options.batch_events = random.between(1, 40);
    const auto reader = io::make_grid_mesh(std::move(grid), options, {.skip_nodata = skips, .renumber = false});
    const Delivered all = deliver(*reader, options.batch_events);
    EXPECT_EQ(all.vertices, vertices) << "seed " << seed + i;
    EXPECT_EQ(all.simplices, simplices_of_grid(shape, present)) << "seed " << seed + i;
    for (std::size_t k = 0; k < vertices.size(); ++k)
      for (std::size_t axis = 0; axis < all.positions[k].size(); ++axis)
        EXPECT_EQ(all.positions[k][axis], position_in(shape, vertices[k])[axis]);
    ASSERT_FALSE(HasFailure()) << "seed " << seed + i;
  }
}

TEST(GridMesh, RenumbersVerticesThatStay) {
  auto grid = std::make_unique<MemoryGrid>(GridShape{3, 2, 1}, std::vector<double>{1, kNan, 2, 3, 4, kNan});
  const auto reader = io::make_grid_mesh(std::move(grid), {}, {.skip_nodata = true, .renumber = true});
  const Delivered all = deliver(*reader, 65536);
  EXPECT_EQ(all.vertices, (std::vector<std::uint64_t>{0, 1, 2, 3}));
  // One triangle and a point are left.
  EXPECT_EQ(all.simplices, (std::set<std::vector<std::uint64_t>>{{0, 2, 3}}));
  EXPECT_EQ(reader->warnings(), std::vector<std::string>{"2 vertices without data were skipped"});
}

TEST(GridMesh, GivesTwoCoordinatesToAnImageOfTwoAxesAndAppliesOriginAndSteps) {
  auto grid = std::make_unique<MemoryGrid>(GridShape{2, 2, 1}, std::vector<double>(4));
  grid->change_info().origin = {10, 20, 0};
  grid->change_info().step = {{{2, 0.5, 0}, {0, -3, 0}, {0, 0, 1}}};
  const Delivered all = deliver(*io::make_grid_mesh(std::move(grid), {}), 65536);
  EXPECT_EQ(all.positions, (std::vector<std::vector<double>>{{10, 20}, {12, 20.5}, {10, 17}, {12, 17.5}}));
}

TEST(GridMesh, RefusesAValueThatIsNotFiniteOnlyIfItIsUsed) {
  const auto read = [](std::vector<std::string> properties) {
    auto grid = std::make_unique<MemoryGrid>(GridShape{2, 1, 1}, std::vector<double>{1, 2, 3, kNan}, 2);
    ReadOptions options;
    options.properties = std::move(properties);
    const auto reader = io::make_grid_mesh(std::move(grid), options);
    for (MeshBatch batch; reader->read(batch);) continue;
    return reader->warnings();
  };
  EXPECT_EQ(read({"value"}),
            (std::vector<std::string>{"each vertex has 2 values; value is the first, value:1 the second",
                                      "1 value of the image is not finite"}));
  try {
    read({"value", "value:1"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_STREQ(error.what(), "memory:8: value:1 of vertex 1 is not finite");
  }
  EXPECT_THROW(read({"value:2"}), Error);
}

TEST(GridMesh, CountsTheValueForNoDataAsANumberUnlessItIsSkipped) {
  auto grid = std::make_unique<MemoryGrid>(GridShape{2, 2, 1}, std::vector<double>{1, -1, -1, 2});
  grid->change_info().nodata = -1;
  const auto reader = io::make_grid_mesh(std::move(grid), {});
  EXPECT_EQ(deliver(*reader, 65536).vertices.size(), 4u);
  EXPECT_EQ(reader->warnings(),
            std::vector<std::string>{
                "2 vertices have the value that stands for no data; it counts as a number without --nodata skip"});
}

TEST(GridMesh, CountsTheValuesThatItHolds) {
  constexpr unsigned kComponents = 4096;
  constexpr std::size_t kVertices = 200;
  std::vector<double> values(kVertices * kComponents);
  for (std::size_t v = 0; v < kVertices; ++v) values[v * kComponents + 7] = static_cast<double>(v);
  ReadOptions options;
  options.properties = {"value:7"};
  const auto reader =
      io::make_grid_mesh(std::make_unique<MemoryGrid>(GridShape{20, 10, 1}, values, kComponents), options);
  std::size_t vertices = 0;
  for (MeshBatch batch; reader->read(batch);)
    for (const double value : batch.properties[0]) EXPECT_EQ(value, static_cast<double>(vertices++));
  EXPECT_EQ(vertices, kVertices);
  EXPECT_GE(reader->memory_bytes(), kComponents * sizeof(double));
  EXPECT_LE(reader->memory_bytes(), std::uint64_t{1} << 20);
}

TEST(GridMesh, LeavesOutSimplices) {
  const auto reader = io::make_grid_mesh(std::make_unique<MemoryGrid>(GridShape{3, 3, 3}, std::vector<double>(27)), {});
  ASSERT_TRUE(reader->leave_out_simplices());
  std::size_t vertices = 0;
  for (MeshBatch batch; reader->read(batch);) {
    vertices += batch.vertex_count;
    EXPECT_EQ(batch.simplex_count(), 0u);
    EXPECT_TRUE(batch.finalized.empty());
  }
  EXPECT_EQ(vertices, 27u);
  std::vector<double> values(27);
  values[4] = values[26] = kNan;
  const auto skipping =
      io::make_grid_mesh(std::make_unique<MemoryGrid>(GridShape{3, 3, 3}, values), {}, {.skip_nodata = true});
  ASSERT_TRUE(skipping->leave_out_simplices());
  std::vector<std::uint64_t> numbers;
  for (MeshBatch batch; skipping->read(batch);) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) numbers.push_back(batch.first_vertex.value() + i);
    EXPECT_EQ(batch.simplex_count(), 0u);
  }
  ASSERT_EQ(numbers.size(), 25u);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], i < 4 ? i : i + 1);
  // Numbers without gaps say nothing of places.
  EXPECT_FALSE(io::make_grid_mesh(std::make_unique<MemoryGrid>(GridShape{2, 2, 2}, std::vector<double>(8)), {},
                                  {.skip_nodata = true, .renumber = true})
                   ->leave_out_simplices());
}

}  // namespace
}  // namespace reeb::test
