// The memory of the on-line engine where no vertex is final before the end.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "libreeb/engine/online_reeb.h"
#include "tests/support/held_memory.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

struct Grid {
  std::vector<double> values;
  std::vector<std::array<VertexId, 3>> triangles;
};

// A square grid of 2 * (width - 1)^2 triangles.
Grid grid(std::uint64_t width, bool is_random_function, bool is_shuffled) {
  Grid mesh;
  Random random(1);
  for (std::uint64_t y = 0; y < width; ++y)
    for (std::uint64_t x = 0; x < width; ++x) {
      mesh.values.push_back(is_random_function ? random.unit()
                                               : static_cast<double>(x * y % 97) + 0.001 * random.unit());
      if (x == 0 || y == 0) continue;
      const VertexId d(y * width + x), c(d.value() - 1), b(d.value() - width), a(b.value() - 1);
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  if (is_shuffled) random.shuffle(mesh.triangles);
  return mesh;
}

TEST(OnlineMemory, WithoutFinalizationIsLinearInAnyOrder) {
  constexpr std::size_t kMostBytes = 300;  // per triangle; a live graph of open vertices would take thousands
  for (const bool is_random_function : {false, true})
    for (const bool is_shuffled : {false, true})
      for (const unsigned width : {100u, 200u}) {
        const Grid mesh = grid(width, is_random_function, is_shuffled);
        const std::size_t triangles = mesh.triangles.size();
        SCOPED_TRACE(testing::Message() << "random function " << is_random_function << ", shuffled " << is_shuffled
                                        << ", " << triangles << " triangles");
        std::uint64_t said = 0;
        const std::size_t peak = peak_of([&] {
          OnlineReeb engine;
          for (const double value : mesh.values) engine.add_vertex(value);
          for (const auto& triangle : mesh.triangles) engine.add_simplex(triangle);
          said = engine.memory_bytes();
          const ReebGraph graph = engine.snapshot();
          engine.finish();
          EXPECT_EQ(engine.snapshot(), graph);
        });
        EXPECT_LE(peak, said) << "it took more than it said";
        EXPECT_LE(said, kMostBytes * (triangles + 4096));
      }
}

}  // namespace
}  // namespace reeb::test
