// Generated balls with tunnels against independent counts, and their graphs against the reference.
#include "io/generate/ball.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/containers/union_find.h"
#include "libreeb/graph/reeb_graph.h"
#include "tests/model/reference_reeb.h"

namespace reeb::test {
namespace {

using Corners = std::vector<std::uint64_t>;
using Point = std::array<double, 3>;

struct Ball {
  std::vector<Point> positions;
  std::vector<Corners> tetrahedra;
  io::ExpectedTopology expected;
};

Ball collect(const io::GeneratorOptions& options, std::size_t batch_events = 1000) {
  ReadOptions read_options;
  read_options.batch_events = batch_events;
  const auto reader = io::generate_mesh(options, read_options);
  Ball ball;
  ball.expected = reader->topology();
  for (MeshBatch batch; reader->read(batch);) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i)
      ball.positions.push_back({batch.coordinates[0][i], batch.coordinates[1][i], batch.coordinates[2][i]});
    batch.for_each_simplex([&](std::span<const VertexId> corners) {
      EXPECT_EQ(corners.size(), 4u);
      Corners& own = ball.tetrahedra.emplace_back();
      for (const VertexId v : corners) own.push_back(v.value());
    });
  }
  return ball;
}

io::GeneratorOptions ball_of(std::uint64_t tetrahedra, std::uint64_t handles) {
  return {.kind = io::MeshKind::kBall, .tetrahedra = tetrahedra, .handles = handles};
}

std::vector<io::GeneratorOptions> some_balls() {
  return {ball_of(1, 0),    ball_of(1, 1),     ball_of(48, 0),    ball_of(400, 2),    ball_of(1000, 5),
          ball_of(3000, 4), ball_of(3000, 50), ball_of(20000, 0), ball_of(20000, 11), ball_of(60000, 3)};
}

// The distinct faces with `corners` corners of all tetrahedra, and how many tetrahedra have each.
std::map<Corners, unsigned> faces_of(const Ball& ball, int corners) {
  std::map<Corners, unsigned> faces;
  for (const Corners& t : ball.tetrahedra)
    for (unsigned subset = 1; subset < 16; ++subset) {
      if (__builtin_popcount(subset) != corners) continue;
      Corners face;
      for (unsigned k = 0; k < 4; ++k)
        if ((subset >> k & 1) != 0) face.push_back(t[k]);
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  return faces;
}

std::int64_t signed_size(const std::map<Corners, unsigned>& faces, int corners) {
  const auto size = static_cast<std::int64_t>(faces.size());
  return corners % 2 == 1 ? size : -size;
}

// Six times the volume.
double orientation(const Ball& ball, const Corners& t) {
  std::array<Point, 3> edge;
  for (std::size_t e = 0; e < 3; ++e)
    for (std::size_t k = 0; k < 3; ++k) edge[e][k] = ball.positions[t[e + 1]][k] - ball.positions[t[0]][k];
  return edge[0][0] * (edge[1][1] * edge[2][2] - edge[1][2] * edge[2][1]) -
         edge[0][1] * (edge[1][0] * edge[2][2] - edge[1][2] * edge[2][0]) +
         edge[0][2] * (edge[1][0] * edge[2][1] - edge[1][1] * edge[2][0]);
}

TEST(Ball, HasTheTopologyItPromises) {
  for (const io::GeneratorOptions& options : some_balls()) {
    SCOPED_TRACE(testing::Message() << options.tetrahedra << " tetrahedra, " << options.handles << " handles");
    const Ball ball = collect(options);
    ASSERT_EQ(ball.positions.size(), ball.expected.vertices);
    ASSERT_EQ(ball.tetrahedra.size(), ball.expected.tetrahedra);
    EXPECT_EQ(ball.expected.first_betti, options.handles);
    EXPECT_EQ(ball.expected.triangles, 0u);
    std::array<std::map<Corners, unsigned>, 4> faces;
    std::int64_t euler = 0;
    for (int corners = 1; corners <= 4; ++corners) {
      faces[static_cast<std::size_t>(corners - 1)] = faces_of(ball, corners);
      euler += signed_size(faces[static_cast<std::size_t>(corners - 1)], corners);
    }
    EXPECT_EQ(faces[0].size(), ball.positions.size()) << "a vertex is in no tetrahedron";
    EXPECT_EQ(faces[3].size(), ball.tetrahedra.size()) << "a tetrahedron is there twice, or has a corner twice";
    // A solid body with N handles is a circle N times, up to homotopy: 1 - N.
    EXPECT_EQ(euler, 1 - static_cast<std::int64_t>(options.handles));
    EXPECT_EQ(euler, ball.expected.euler_characteristic);

    // Its surface is closed, connected and of genus N: 2 - 2 N.
    std::map<Corners, unsigned> edges_of_surface;
    std::set<std::uint64_t> vertices_of_surface;
    UnionFind sets(static_cast<std::uint32_t>(ball.positions.size()));
    std::int64_t triangles_of_surface = 0;
    for (const auto& [face, users] : faces[2]) {
      ASSERT_LE(users, 2u);
      if (users == 2) continue;
      ++triangles_of_surface;
      vertices_of_surface.insert(face.begin(), face.end());
      for (const Corners& edge : {Corners{face[0], face[1]}, {face[0], face[2]}, {face[1], face[2]}}) {
        ++edges_of_surface[edge];
        sets.unite(static_cast<std::uint32_t>(edge[0]), static_cast<std::uint32_t>(edge[1]));
      }
    }
    for (const auto& [edge, users] : edges_of_surface) ASSERT_EQ(users, 2u);
    EXPECT_EQ(static_cast<std::int64_t>(vertices_of_surface.size()) -
                  static_cast<std::int64_t>(edges_of_surface.size()) + triangles_of_surface,
              2 - 2 * static_cast<std::int64_t>(options.handles));
    for (const std::uint64_t v : vertices_of_surface)
      ASSERT_EQ(sets.find(static_cast<std::uint32_t>(v)),
                sets.find(static_cast<std::uint32_t>(*vertices_of_surface.begin())));

    for (const Corners& t : ball.tetrahedra) ASSERT_GT(orientation(ball, t), 0);
  }
}

// The link of an inner vertex is a sphere, that of a vertex of the surface a disc.
TEST(Ball, IsAManifold) {
  for (const io::GeneratorOptions& options : {ball_of(400, 2), ball_of(3000, 4), ball_of(20000, 11)}) {
    const Ball ball = collect(options);
    std::vector<Ball> links(ball.positions.size());  // triangles with a corner of their own, as tetrahedra
    for (const Corners& t : ball.tetrahedra)
      for (const std::uint64_t v : t) links[v].tetrahedra.push_back(t);
    for (std::uint64_t v = 0; v < links.size(); ++v) {
      std::set<std::uint64_t> vertices;
      std::set<Corners> edges;
      std::map<Corners, unsigned> uses;
      std::int64_t boundary = 0;
      UnionFind sets(static_cast<std::uint32_t>(ball.positions.size()));
      for (const Corners& t : links[v].tetrahedra) {
        Corners face;
        for (const std::uint64_t w : t)
          if (w != v) face.push_back(w);
        std::sort(face.begin(), face.end());
        vertices.insert(face.begin(), face.end());
        for (const Corners& edge : {Corners{face[0], face[1]}, {face[0], face[2]}, {face[1], face[2]}}) {
          ++uses[edge];
          sets.unite(static_cast<std::uint32_t>(edge[0]), static_cast<std::uint32_t>(edge[1]));
        }
      }
      for (const auto& [edge, users] : uses) {
        ASSERT_LE(users, 2u);
        boundary += users == 1 ? 1 : 0;
      }
      for (const std::uint64_t w : vertices)
        ASSERT_EQ(sets.find(static_cast<std::uint32_t>(w)), sets.find(static_cast<std::uint32_t>(*vertices.begin())));
      const auto euler = static_cast<std::int64_t>(vertices.size()) - static_cast<std::int64_t>(uses.size()) +
                         static_cast<std::int64_t>(links[v].tetrahedra.size());
      ASSERT_EQ(euler, boundary == 0 ? 2 : 1) << "vertex " << v;
    }
  }
}

TEST(Ball, ZHasALoopForEachHandleAndNothingHasMore) {
  for (const io::GeneratorOptions& options :
       {ball_of(1, 0), ball_of(1, 1), ball_of(400, 2), ball_of(1000, 5), ball_of(2500, 3)}) {
    SCOPED_TRACE(testing::Message() << options.tetrahedra << " tetrahedra, " << options.handles << " handles");
    const Ball ball = collect(options);
    Complex complex;
    complex.positions = ball.positions;
    complex.simplices = ball.tetrahedra;
    complex.values.resize(ball.positions.size());
    for (unsigned function = 0; function < 6; ++function) {
      for (std::size_t v = 0; v < complex.values.size(); ++v)
        complex.values[v] = function < 3    ? ball.positions[v][function]
                            : function == 3 ? static_cast<double>(v)
                            : function == 4 ? static_cast<double>(v * 2654435761 % 1009)
                                            : ball.positions[v][1] + 0.1 * ball.positions[v][2];
      const BettiNumbers betti = betti_numbers(reference_reeb(complex));
      EXPECT_EQ(betti.components, 1u);
      EXPECT_LE(betti.loops, options.handles) << "function " << function;
      // A level of z lies in one or two layers, which the tunnels divide.
      if (function == 2) {
        EXPECT_EQ(betti.loops, options.handles);
      }
    }
  }
}

TEST(Ball, IsTheSameInEveryOrderAndWithAnyBatches) {
  for (io::GeneratorOptions options : some_balls()) {
    const Ball rows = collect(options), small = collect(options, 7);
    EXPECT_EQ(rows.positions, small.positions);
    EXPECT_EQ(rows.tetrahedra, small.tetrahedra);
    options.order = io::MeshOrder::kRandom;
    const Ball random = collect(options);
    EXPECT_EQ(rows.positions, random.positions);
    if (rows.tetrahedra.size() > 10) {
      EXPECT_NE(rows.tetrahedra, random.tetrahedra);
    }
    std::vector<Corners> sorted = rows.tetrahedra, other = random.tetrahedra;
    std::sort(sorted.begin(), sorted.end());
    std::sort(other.begin(), other.end());
    EXPECT_EQ(sorted, other);
  }
}

TEST(Ball, HasAboutAsManyTetrahedraAsAsked) {
  for (const std::uint64_t tetrahedra : {20'000u, 1'000'000u, 372'000'000u})
    for (const std::uint64_t handles : {0u, 1u, 10u, 100u}) {
      const auto got = static_cast<double>(io::DrilledBall(tetrahedra, handles).topology().tetrahedra);
      EXPECT_NEAR(got, static_cast<double>(tetrahedra), 0.1 * static_cast<double>(tetrahedra)) << handles;
    }
  // At least 48 for each handle, less where a row of tiles is not full.
  const io::ExpectedTopology crowded = io::DrilledBall(1, 1'000'000).topology();
  EXPECT_EQ(crowded.tetrahedra, 48'000'000u);
  EXPECT_EQ(crowded.first_betti, 1'000'000u);
}

// Against the definition of the holes.
TEST(PerforatedSquare, NumbersArePlacesInOrder) {
  for (const std::uint64_t size : {1u, 5u, 9u, 20u})
    for (const std::uint64_t count : {0u, 1u, 2u, 3u, 4u})
      for (const std::uint64_t width : {0u, 1u, 2u}) {
        const std::uint64_t pitch = std::max<std::uint64_t>(size / 2, 1);
        if (pitch < width + 2 && count > 0) continue;
        const io::PerforatedSquare square(size,
                                          {.count = count, .tiles = 2, .pitch = pitch, .lead = 1, .width = width});
        std::uint64_t number = 0;
        for (std::uint64_t j = 0; j < size; ++j)
          for (std::uint64_t i = 0; i < size; ++i) {
            bool in_hole = false;
            for (std::uint64_t hole = 0; hole < count; ++hole) {
              const std::uint64_t at_i = hole % 2 * pitch + 1, at_j = hole / 2 * pitch + 1;
              in_hole |= i >= at_i && i < at_i + width && j >= at_j && j < at_j + width;
            }
            if (in_hole) continue;
            ASSERT_EQ(square.number({i, j}), number) << size << ' ' << count << ' ' << width;
            ASSERT_EQ(square.at(number), (io::GridPoint{i, j}));
            ++number;
          }
        EXPECT_EQ(square.count(), number);
      }
}

TEST(Ball, RefusesWhatNoBallCanMeet) {
  io::GeneratorOptions tiles = ball_of(1000, 1);
  tiles.order = io::MeshOrder::kTiles;
  for (const io::GeneratorOptions& options :
       {ball_of(0, 1), ball_of(~std::uint64_t{0}, 1), ball_of(1000, ~std::uint64_t{0}), tiles})
    EXPECT_THROW(io::generate_mesh(options), Error);
}

}  // namespace
}  // namespace reeb::test
