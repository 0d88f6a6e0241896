// Parts of a mesh in balls, taken up group by group: what is cut out of them follows from the balls alone.
#include "ooc/patches/divided_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace reeb::test {
namespace {

using ooc::Ball;

struct Mesh {
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// A square grid of unit cells, bent, with its triangles in random order; some of them are missing or repeated.
Mesh grid(std::uint32_t side, std::mt19937& random) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < side * side; ++i)
    mesh.points.push_back({double(i % side), double(i / side), 0.1 * double(i % 7)});
  for (std::uint32_t y = 0; y + 1 < side; ++y)
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const std::uint32_t a = y * side + x;
      mesh.triangles.push_back({a, a + 1, a + side});
      mesh.triangles.push_back({a + 1, a + side + 1, a + side});
    }
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  const std::size_t few = mesh.triangles.size() / 20;
  for (std::size_t i = 0; i < few; ++i) mesh.triangles[i] = mesh.triangles[few + i];
  return mesh;
}

double value_of(std::size_t function, std::uint64_t vertex) { return double(vertex) * (function == 0 ? 0.5 : -3); }

// In batches: all vertices first, as in most files.
template <class Add>
void read(const Mesh& mesh, const Add& add) {
  MeshBatch batch;
  batch.coordinates.resize(3);
  std::vector<std::vector<double>> values(2);
  for (std::size_t first = 0; first < mesh.points.size(); first += 1000) {
    batch.first_vertex = VertexId(first);
    batch.vertex_count = std::min<std::size_t>(1000, mesh.points.size() - first);
    for (std::size_t k = 0; k < 3; ++k) batch.coordinates[k].clear();
    for (auto& of_function : values) of_function.clear();
    for (std::size_t i = first; i < first + batch.vertex_count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) batch.coordinates[k].push_back(mesh.points[i][k]);
      for (std::size_t f = 0; f < 2; ++f) values[f].push_back(value_of(f, i));
    }
    add(batch, values);
  }
  batch.vertex_count = 0;
  for (auto& of_function : values) of_function.clear();
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) batch.triangles().emplace_back(v);
    if (batch.triangles().size() < 3000) continue;
    add(batch, values);
    batch.triangles().clear();
  }
  add(batch, values);
}

struct Expected {
  std::vector<std::uint32_t> vertices;
  std::vector<bool> whole;
  std::set<std::set<std::uint32_t>> triangles;
};

// By the definition: from the seed across triangles whose corners are all in the balls.
Expected patch_around(const Mesh& mesh, std::uint32_t seed, const std::vector<Ball>& balls) {
  const auto inside = [&](std::uint32_t v) {
    return std::ranges::any_of(balls, [&](const Ball& ball) { return ball.contains(mesh.points[v]); });
  };
  std::set<std::uint32_t> reached;
  if (inside(seed)) reached.insert(seed);
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const auto& t : mesh.triangles)
      if (std::ranges::all_of(t, inside) && std::ranges::any_of(t, [&](auto v) { return reached.contains(v); }))
        reached.insert(t.begin(), t.end());
  }
  Expected result;
  result.vertices.assign(reached.begin(), reached.end());
  result.whole.assign(reached.size(), true);
  for (const auto& t : mesh.triangles) {
    if (std::ranges::all_of(t, [&](auto v) { return reached.contains(v); })) {
      result.triangles.insert(std::set(t.begin(), t.end()));
      continue;
    }
    for (const std::uint32_t v : t)
      if (const auto it = std::ranges::lower_bound(result.vertices, v); it != result.vertices.end() && *it == v)
        result.whole[static_cast<std::size_t>(it - result.vertices.begin())] = false;
  }
  return result;
}

void expect_patch(const ooc::CollectedSurface::Patch& patch, const Expected& expected) {
  const SurfacePatch& surface = patch.surface;
  ASSERT_EQ(surface.vertex_count(), expected.vertices.size());
  for (std::uint32_t i = 0; i < surface.vertex_count(); ++i) {
    EXPECT_EQ(surface.vertex(i).value(), expected.vertices[i]);
    EXPECT_EQ(surface.whole(i), expected.whole[i]) << expected.vertices[i];
    for (std::size_t f = 0; f < 2; ++f) EXPECT_EQ(patch.values[f][i], value_of(f, expected.vertices[i]));
  }
  std::set<std::set<std::uint32_t>> triangles;
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    std::set<std::uint32_t> corners;
    for (const std::uint32_t v : surface.triangle(t)) corners.insert(expected.vertices[v]);
    EXPECT_TRUE(triangles.insert(corners).second);
  }
  EXPECT_EQ(triangles, expected.triangles);
}

TEST(DividedSurface, PatchesFollowFromTheirBallsInAnyGroups) {
  std::mt19937 random(7);
  const Mesh mesh = grid(40, random);
  struct Place {
    std::uint32_t seed;
    std::vector<Ball> balls;
  };
  std::vector<Place> places;
  for (int i = 0; i < 60; ++i) {
    const auto vertex = [&] { return static_cast<std::uint32_t>(random() % mesh.points.size()); };
    const std::uint32_t seed = vertex();
    Place place{seed, {{mesh.points[seed], std::array{1.2, 3.0, 7.5, 0.01}[random() % 4]}}};
    Point beside = mesh.points[seed];
    beside[0] += 4;
    place.balls.push_back({beside, 2.5});
    places.push_back(place);
  }
  // Every third place is measured.
  double length = 0;
  std::size_t edges = 0;
  for (const auto& t : mesh.triangles) {
    if (!std::ranges::all_of(t, [&](std::uint32_t v) {
          for (std::size_t i = 0; i < places.size(); i += 3)
            for (const Ball& ball : places[i].balls)
              if (ball.contains(mesh.points[v])) return true;
          return false;
        }))
      continue;
    for (std::size_t k = 0; k < 3; ++k) length += distance(mesh.points[t[k]], mesh.points[t[(k + 1) % 3]]);
    edges += 3;
  }
  ASSERT_GT(edges, 300u);
  for (const std::uint32_t groups : {1u, 2u, 7u, 60u}) {
    std::vector<ooc::GroupedBall> balls;
    for (std::uint32_t i = 0; i < places.size(); ++i)
      for (const Ball& ball : places[i].balls) balls.push_back({ball, i % groups, i % 3 == 0});
    const io::TempDir temp(testing::TempDir());
    MemoryBudget budget;
    ooc::DividedSurface surfaces(balls, groups, 2, temp, budget);
    read(mesh, [&](const MeshBatch& batch, const auto& values) { surfaces.add(batch, values); });
    surfaces.finish();
    EXPECT_NEAR(surfaces.mean_edge(), length / static_cast<double>(edges), 1e-12);
    for (std::uint32_t group = 0; group < groups; ++group) {
      const ooc::CollectedSurface surface = surfaces.surface(group);
      for (std::uint32_t i = group; i < places.size(); i += groups) {
        SCOPED_TRACE(testing::Message() << groups << " groups, place " << i);
        const std::array seeds = {VertexId(places[i].seed)};
        expect_patch(surface.cut(seeds, places[i].balls, 10'000), patch_around(mesh, places[i].seed, places[i].balls));
      }
    }
  }
}

TEST(DividedSurface, HasOneGroupInMemory) {
  std::mt19937 random(3);
  constexpr std::uint32_t kSide = 400, kGroups = 40;
  const Mesh mesh = grid(kSide, random);
  // All of the mesh, in strips.
  std::vector<ooc::GroupedBall> balls;
  for (std::uint32_t y = 0; y < kSide; y += 2)
    for (std::uint32_t x = 0; x < kSide; x += 2)
      balls.push_back({{{double(x), double(y), 0}, 2}, y / (kSide / kGroups)});
  const io::TempDir temp(testing::TempDir());
  MemoryBudget budget;
  ooc::DividedSurface surfaces(balls, kGroups, 2, temp, budget);
  read(mesh, [&](const MeshBatch& batch, const auto& values) { surfaces.add(batch, values); });
  surfaces.finish();
  const std::uint64_t all = ooc::CollectedSurface::memory_bytes(mesh.points.size(), mesh.triangles.size(), 2);
  EXPECT_LT(budget.peak_bytes(), all / 2);  // balls, and 4 bytes for each vertex
  EXPECT_LT(budget.used_bytes(), (kGroups + 1) * (std::uint64_t{32} << 10));
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const std::uint64_t before = budget.used_bytes();
    const ooc::CollectedSurface surface = surfaces.surface(group);
    EXPECT_GT(budget.used_bytes() - before, all / kGroups);
    EXPECT_LT(budget.used_bytes() - before, 2 * all / kGroups);
  }
}

}  // namespace
}  // namespace reeb::test
