// A grid that is cut into boxes has the graph of its simplices, however it is cut, and no vertex is lost.
#include "libreeb/grid/box_sweep.h"

#include <gtest/gtest.h>

#include "tests/libreeb/grid/glued_boxes.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

TEST(BoxSweep, FindsTheGraphOfTheSimplices) {
  const std::uint64_t seed = base_seed();
  for (std::uint64_t i = 0; i < case_count(3000); ++i) {
    Random random(seed + i);
    const GridShape shape = random_grid(random);
    const Complex complex = complex_of_grid(shape, random_grid_values(shape, random));
    BoxCut cut{};
    for (auto& cells : cut.cells) cells = static_cast<std::uint32_t>(random.between(1, 4));
    cut.options.bucket_exponent = -1;
    GluedBoxesSink sink;
    BoxGlue glue(sink);
    for (const Fragment& fragment : fragments_of_boxes(shape, complex.values, cut)) glue.add(fragment);
    EXPECT_EQ(glue.live_vertices(), 0u);
    EXPECT_EQ(glue.live_arcs(), 0u);
    ASSERT_EQ(describe(sink.result.graph()), describe(without_positions(reference_reeb(complex))))
        << "seed " << seed + i << ", " << name_of(shape, cut) << "\n"
        << describe(complex);
    ASSERT_EQ(sink.result.vertices(), complex.vertex_count()) << "seed " << seed + i << ", " << name_of(shape, cut);
  }
}

}  // namespace
}  // namespace reeb::test
