// Generated meshes of every kind and order against an independent count of their topology.
#include "io/generate/generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>
#include <vector>

#include "io/generate/patched_grid.h"
#include "io/generate/permutation.h"
#include "libreeb/base/error.h"
#include "libreeb/containers/union_find.h"

namespace reeb::io {
namespace {

using Triangle = std::array<std::uint64_t, 3>;
using Position = std::vector<double>;

struct Mesh {
  std::vector<Position> positions;
  std::vector<Triangle> triangles;
  ExpectedTopology expected;
};

Mesh collect(const GeneratorOptions& options, std::size_t batch_events = 1000) {
  ReadOptions read_options;
  read_options.batch_events = batch_events;
  const auto reader = generate_mesh(options, read_options);
  Mesh mesh;
  mesh.expected = reader->topology();
  for (MeshBatch batch; reader->read(batch);) {
    EXPECT_EQ(batch.first_vertex.value(), mesh.positions.size());
    EXPECT_LE(batch.vertex_count + batch.triangle_count(), batch_events);
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      Position p;
      for (const auto& column : batch.coordinates) p.push_back(column[i]);
      mesh.positions.push_back(p);
    }
    for (std::size_t i = 0; i < batch.triangles().size(); i += 3)
      mesh.triangles.push_back(
          {batch.triangles()[i].value(), batch.triangles()[i + 1].value(), batch.triangles()[i + 2].value()});
  }
  return mesh;
}

// The result of an independent count, from edges and union-find only.
struct Counted {
  std::uint64_t components = 0, edges = 0, boundary_loops = 0, unused_vertices = 0;
  std::int64_t euler_characteristic = 0;
  bool edges_are_manifold = true, vertices_are_manifold = true, oriented = true;
  bool legal = true;  // indices in range, corners and triangles distinct
};

std::uint64_t component_count(UnionFind& sets, const std::vector<std::uint64_t>& members) {
  std::set<std::uint32_t> roots;
  for (const auto v : members) roots.insert(sets.find(static_cast<std::uint32_t>(v)));
  return roots.size();
}

// A vertex is manifold if its link is one path or circle. If the edges are manifold, a connected link is enough.
bool links_are_connected(const Mesh& mesh) {
  std::vector<std::vector<Triangle>> stars(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (const auto v : t) stars[v].push_back(t);
  for (std::size_t v = 0; v < stars.size(); ++v) {
    std::map<std::uint64_t, std::uint32_t> local;
    for (const Triangle& t : stars[v])
      for (const auto w : t)
        if (w != v) local.emplace(w, static_cast<std::uint32_t>(local.size()));
    UnionFind sets(static_cast<std::uint32_t>(local.size()));
    auto pieces = local.size();
    for (const Triangle& t : stars[v]) {
      const auto at = static_cast<std::size_t>(std::find(t.begin(), t.end(), v) - t.begin());
      pieces -= sets.unite(local.at(t[(at + 1) % 3]), local.at(t[(at + 2) % 3])) ? 1u : 0u;
    }
    if (pieces > 1) return false;
  }
  return true;
}

Counted count(const Mesh& mesh) {
  Counted c;
  const std::uint64_t n = mesh.positions.size();
  UnionFind sets(static_cast<std::uint32_t>(n)), boundary(static_cast<std::uint32_t>(n));
  std::unordered_map<std::uint64_t, std::array<int, 2>> uses;  // of an edge, by direction
  std::vector<bool> used(n);
  std::set<Triangle> distinct;
  for (Triangle t : mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= n || t[0] == t[1] || t[1] == t[2] || t[0] == t[2]) {
      c.legal = false;
      return c;
    }
    for (unsigned k = 0; k < 3; ++k) {
      const auto a = t[k], b = t[(k + 1) % 3];
      used[a] = true;
      sets.unite(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
      ++uses[std::min(a, b) * n + std::max(a, b)][a < b ? 0 : 1];
    }
    std::sort(t.begin(), t.end());
    c.legal &= distinct.insert(t).second;
  }
  std::vector<std::uint64_t> on_boundary;
  for (const auto& [edge, directions] : uses) {
    const int all = directions[0] + directions[1];
    c.edges_are_manifold &= all <= 2;
    c.oriented &= directions[0] <= 1 && directions[1] <= 1;
    if (all != 1) continue;
    boundary.unite(static_cast<std::uint32_t>(edge / n), static_cast<std::uint32_t>(edge % n));
    on_boundary.push_back(edge / n);
  }
  std::vector<std::uint64_t> everything(n);
  std::iota(everything.begin(), everything.end(), std::uint64_t{0});
  c.components = component_count(sets, everything);
  c.boundary_loops = component_count(boundary, on_boundary);
  c.unused_vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
  c.edges = uses.size();
  c.euler_characteristic = static_cast<std::int64_t>(n) - static_cast<std::int64_t>(c.edges) +
                           static_cast<std::int64_t>(mesh.triangles.size());
  c.vertices_are_manifold = links_are_connected(mesh);
  return c;
}

// The mesh up to renumbering: its triangles by the positions of their corners.
std::vector<std::array<Position, 3>> by_position(const Mesh& mesh) {
  std::vector<std::array<Position, 3>> all;
  for (const Triangle& t : mesh.triangles) {
    all.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
    std::sort(all.back().begin(), all.back().end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

// The largest number of vertices that are used both before and after a triangle.
std::uint64_t front_width(const Mesh& mesh) {
  std::vector<std::size_t> first(mesh.positions.size(), mesh.triangles.size()), last(first.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto v : mesh.triangles[t]) {
      first[v] = std::min(first[v], t);
      last[v] = t;
    }
  std::vector<std::int64_t> change(mesh.triangles.size() + 1);
  for (std::size_t v = 0; v < first.size(); ++v) {
    ++change[first[v]];
    --change[last[v]];
  }
  std::int64_t active = 0, widest = 0;
  for (const auto step : change) widest = std::max(widest, active += step);
  return static_cast<std::uint64_t>(widest);
}

constexpr std::array kOrders = {MeshOrder::kRows,  MeshOrder::kPatches,     MeshOrder::kRandom,
                                MeshOrder::kTiles, MeshOrder::kRandomTiles, MeshOrder::kSeamsLast};

// A Sierpinski simplex has no tiles.
bool exists(const GeneratorOptions& options) {
  return options.kind != MeshKind::kSierpinski || options.order < MeshOrder::kTiles;
}

class Generated : public testing::TestWithParam<GeneratorOptions> {};

TEST_P(Generated, HasTheTopologyItPromisesInEveryOrder) {
  GeneratorOptions options = GetParam();
  for (const MeshOrder order : kOrders) {
    options.order = order;
    options.tile_cells = 1 + options.triangles % 41;
    if (!exists(options)) continue;
    SCOPED_TRACE(testing::Message() << "order " << static_cast<int>(order));
    const Mesh mesh = collect(options);
    const Counted counted = count(mesh);
    ASSERT_TRUE(counted.legal);
    EXPECT_EQ(counted.unused_vertices, 0u);
    EXPECT_EQ(mesh.positions.size(), mesh.expected.vertices);
    EXPECT_EQ(mesh.triangles.size(), mesh.expected.triangles);
    EXPECT_EQ(counted.components, mesh.expected.components);
    EXPECT_EQ(counted.euler_characteristic, mesh.expected.euler_characteristic);
    if (options.kind == MeshKind::kSierpinski) continue;
    EXPECT_TRUE(counted.edges_are_manifold);
    EXPECT_TRUE(counted.vertices_are_manifold);
    EXPECT_TRUE(counted.oriented);
    EXPECT_EQ(counted.boundary_loops, mesh.expected.boundary_loops);
    EXPECT_EQ(counted.euler_characteristic, 2 - 2 * static_cast<std::int64_t>(*mesh.expected.genus) -
                                                static_cast<std::int64_t>(counted.boundary_loops));
  }
}

TEST_P(Generated, IsTheSameMeshInEveryOrder) {
  GeneratorOptions options = GetParam();
  options.order = MeshOrder::kRows;
  const auto rows = by_position(collect(options));
  for (const MeshOrder order : kOrders) {
    options.order = order;
    options.tile_cells = 1 + options.triangles % 41;
    if (!exists(options)) continue;
    EXPECT_TRUE(by_position(collect(options)) == rows) << "order " << static_cast<int>(order);
  }
}

TEST_P(Generated, DoesNotDependOnTheBatchSize) {
  GeneratorOptions options = GetParam();
  const std::size_t small = options.triangles > 5000 ? 100 : 1;
  for (const MeshOrder order : kOrders) {
    options.order = order;
    if (!exists(options)) continue;
    EXPECT_EQ(collect(options, small).triangles, collect(options, 777).triangles);
    EXPECT_EQ(collect(options, small).positions, collect(options, 777).positions);
  }
}

std::vector<GeneratorOptions> all_kinds() {
  std::vector<GeneratorOptions> all;
  for (const auto kind : {MeshKind::kTorus, MeshKind::kTerrain, MeshKind::kGrid, MeshKind::kPlate, MeshKind::kScan}) {
    for (const std::uint64_t triangles : {1u, 50u, 3000u, 30'000u})
      all.push_back({.kind = kind, .triangles = triangles, .seed = triangles});
    // Several patches in each direction, and a last patch that is one cell or one line of vertices wide.
    all.push_back({.kind = kind, .triangles = 70'000, .width = 129});
    all.push_back({.kind = kind, .triangles = 4000, .width = 333});
  }
  for (unsigned dimension = 2; dimension <= 5; ++dimension)
    for (const std::uint64_t triangles : {1u, 3000u, 20'000u})
      all.push_back({.kind = MeshKind::kSierpinski, .triangles = triangles, .dimension = dimension});
  return all;
}
INSTANTIATE_TEST_SUITE_P(Kinds, Generated, testing::ValuesIn(all_kinds()));

// b1 of the 2-skeleton by counting: level L of the Sierpinski triangle has 3^L cells around 1 + 3 + ... + 3^(L-1)
// holes.
TEST(Generator, TheSierpinskiTriangleHasItsKnownNumberOfHoles) {
  std::uint64_t cells = 1, holes = 0;
  for (int level = 0; level < 8; ++level) {
    const auto mesh = generate_mesh({.kind = MeshKind::kSierpinski, .triangles = cells, .dimension = 2});
    EXPECT_EQ(mesh->topology().triangles, cells);
    EXPECT_EQ(mesh->topology().first_betti, holes);
    holes += cells;
    cells *= 3;
  }
}

TEST(Generator, HandlesArePresentInNumbers) {
  EXPECT_GT(generate_mesh({.kind = MeshKind::kPlate, .triangles = 100'000})->topology().genus, 1000u);
  EXPECT_GT(generate_mesh({.kind = MeshKind::kScan, .triangles = 12'000'000})->topology().genus, 500u);
}

TEST(Generator, TheCountIsTheNearestThatTheWidthAllows) {
  for (const auto kind : {MeshKind::kTorus, MeshKind::kTerrain, MeshKind::kPlate, MeshKind::kScan})
    for (const std::uint64_t triangles : {10'000u, 1'000'000u, 372'000'000u}) {
      const auto got = generate_mesh({.kind = kind, .triangles = triangles})->topology().triangles;
      const double side = std::sqrt(static_cast<double>(triangles));
      EXPECT_NEAR(static_cast<double>(got), static_cast<double>(triangles), 2 * side);
    }
}

TEST(Generator, SeedsMakeTheMesh) {
  GeneratorOptions options{.kind = MeshKind::kScan, .triangles = 5000, .order = MeshOrder::kRandom};
  const Mesh one = collect(options), again = collect(options);
  EXPECT_EQ(one.positions, again.positions);
  EXPECT_EQ(one.triangles, again.triangles);
  options.seed = 2;
  const Mesh other = collect(options);
  EXPECT_NE(one.positions, other.positions);
  EXPECT_NE(one.triangles, other.triangles);
}

TEST(Generator, CoordinatesAreExactInFloat32) {
  for (const Position& p : collect({.kind = MeshKind::kScan, .triangles = 5000}).positions)
    for (const double x : p) EXPECT_EQ(x, static_cast<double>(static_cast<float>(x)));
}

TEST(Generator, CoherentOrdersHaveASmallFrontAndRandomHasNot) {
  GeneratorOptions options{.kind = MeshKind::kScan, .triangles = 400'000};
  const std::uint64_t side = 316;  // two sheets, four triangles per cell
  options.order = MeshOrder::kRows;
  EXPECT_LE(front_width(collect(options)), 2 * (side + 10));
  options.order = MeshOrder::kPatches;
  EXPECT_LE(front_width(collect(options)), 2 * (side + 2 * 128 + 10));
  options.order = MeshOrder::kRandom;
  EXPECT_GT(front_width(collect(options)), 100'000u);
}

// A seam of tiles of n cells has about 2 (2 n) vertices of a tile's 2 n^2; half of all seams are open in the middle.
TEST(Generator, TilesHaveTheFrontsOfMergedScans) {
  GeneratorOptions options{.kind = MeshKind::kScan, .triangles = 400'000, .tile_cells = 16};
  const std::uint64_t side = 316, tiles = (side / 16) * (side / 16);
  options.order = MeshOrder::kTiles;
  EXPECT_LE(front_width(collect(options)), 2 * (side + 2 * 16 + 10));
  options.order = MeshOrder::kRandomTiles;
  EXPECT_GT(front_width(collect(options)), tiles * 16);
  options.order = MeshOrder::kSeamsLast;
  EXPECT_GT(front_width(collect(options)), tiles * 4 * 15);
}

TEST(Generator, TilesAreReadTogether) {
  GeneratorOptions options{.kind = MeshKind::kGrid, .triangles = 2 * 12 * 12, .tile_cells = 4, .width = 12};
  options.order = MeshOrder::kRandomTiles;
  const Mesh mesh = collect(options);
  std::set<std::pair<int, int>> tiles;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 32) {
    Position low = mesh.positions[mesh.triangles[t][0]], high = low;
    for (std::size_t in = t; in < t + 32; ++in)
      for (const auto v : mesh.triangles[in])
        for (std::size_t k = 0; k < 2; ++k) {
          low[k] = std::min(low[k], mesh.positions[v][k]);
          high[k] = std::max(high[k], mesh.positions[v][k]);
        }
    EXPECT_EQ(high[0] - low[0], 4);
    EXPECT_EQ(high[1] - low[1], 4);
    tiles.emplace(static_cast<int>(low[0]), static_cast<int>(low[1]));
  }
  EXPECT_EQ(tiles.size(), 9u);

  options.order = MeshOrder::kSeamsLast;
  const Mesh seams = collect(options);
  const auto in_tile = [&](std::size_t t) {
    for (std::size_t k = 0; k < 2; ++k) {
      double low = 12, high = 0;
      for (const auto v : seams.triangles[t]) {
        low = std::min(low, seams.positions[v][k]);
        high = std::max(high, seams.positions[v][k]);
      }
      // The last cells of a tile are seams, but not at the rim of the grid.
      if (static_cast<int>(low) % 4 == 3 && low != 11) return false;
    }
    return true;
  };
  const std::size_t inner = 2 * 10 * 10;
  for (std::size_t t = 0; t < seams.triangles.size(); ++t) EXPECT_EQ(in_tile(t), t < inner) << t;
}

// In patch order, 64K consecutive triangles share few vertices with the rest.
TEST(Generator, PatchesShareFewVertices) {
  const Mesh mesh = collect({.kind = MeshKind::kScan, .triangles = 1'000'000});
  std::vector<std::set<std::size_t>> chunks_of(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto v : mesh.triangles[t]) chunks_of[v].insert(t >> 16);
  const auto shared =
      std::count_if(chunks_of.begin(), chunks_of.end(), [](const auto& chunks) { return chunks.size() > 1; });
  EXPECT_LT(static_cast<double>(shared), 0.05 * static_cast<double>(mesh.positions.size()));
}

TEST(PatchedGrid, RankAndPlaceAreInverse) {
  for (const std::uint64_t columns : {1u, 3u, 8u, 9u, 10u, 23u})
    for (const std::uint64_t rows : {1u, 8u, 9u, 17u})
      for (const std::uint64_t lead : {0u, 1u})
        for (const std::uint64_t side : {1u, 2u, 7u, 8u, 64u}) {
          const PatchedGrid grid(columns, rows, side, lead);
          std::uint64_t patch = 0;
          for (std::uint64_t rank = 0; rank < grid.size(); ++rank) {
            const GridPoint p = grid.at(rank);
            ASSERT_LT(p.i, columns);
            ASSERT_LT(p.j, rows);
            ASSERT_EQ(grid.rank(p), rank) << columns << "x" << rows << " side " << side;
            if (grid.patch_begin(patch + 1) == rank) ++patch;
            ASSERT_LT(rank, grid.patch_begin(patch + 1));
          }
          ASSERT_EQ(grid.patch_count(), patch + 1);
          ASSERT_EQ(grid.patch_begin(patch + 1), grid.size());
        }
}

TEST(Permutation, IsAPermutationThatMixes) {
  for (const std::uint64_t n : {1u, 2u, 3u, 5u, 64u, 1000u, 65'536u, 65'537u}) {
    const Permutation permutation(n, 7);
    std::vector<bool> seen(n);
    std::uint64_t fixed = 0;
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::uint64_t p = permutation(i);
      ASSERT_LT(p, n);
      ASSERT_FALSE(seen[p]);
      seen[p] = true;
      fixed += p == i;
    }
    if (n > 50) {
      EXPECT_LT(fixed, 12u) << "a random permutation has one fixed point on average";
    }
  }
}

TEST(Generator, RefusesWhatNoMeshCanMeet) {
  const auto kind_of = [](const GeneratorOptions& options) {
    try {
      generate_mesh(options);
    } catch (const Error& error) {
      EXPECT_FALSE(error.hint().empty());
      return error.kind();
    }
    return ErrorKind::kInterrupted;  // nothing was thrown
  };
  EXPECT_EQ(kind_of({.triangles = 0}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.triangles = ~std::uint64_t{0}}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.width = 0}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.width = ~std::uint64_t{0}}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.kind = MeshKind::kTorus, .width = 2}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.kind = MeshKind::kSierpinski, .dimension = 6}), ErrorKind::kUsage);
  EXPECT_THROW(mesh_kind("klein"), Error);
  EXPECT_EQ(kind_of({.tile_cells = 0}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({.kind = MeshKind::kSierpinski, .order = MeshOrder::kTiles}), ErrorKind::kUsage);
  GeneratorOptions options;
  for (const char* name : {"sorted", "", "rows:3", "tiles", "tiles:", "tiles:0", "tiles:-1", "tiles:3x", "tiles:N"})
    EXPECT_THROW(set_order(options, name), Error) << name;
  set_order(options, "random-tiles:77");
  EXPECT_EQ(options.order, MeshOrder::kRandomTiles);
  EXPECT_EQ(options.tile_cells, 77u);
  set_order(options, "rows");
  EXPECT_EQ(options.order, MeshOrder::kRows);
}

}  // namespace
}  // namespace reeb::io
