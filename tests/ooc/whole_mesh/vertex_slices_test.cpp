#include "ooc/whole_mesh/vertex_slices.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

TEST(VertexSlices, EveryIdHasOnePlace) {
  test::Random random(test::base_seed());
  for (std::uint64_t round = 0; round < test::case_count(5000); ++round) {
    const std::uint64_t vertices = 1 + random.below(std::uint64_t{1} << random.below(40));
    const std::uint64_t most = random.below(std::uint64_t{1} << random.below(30));
    const VertexSlices slices(vertices, most);
    SCOPED_TRACE(testing::Message() << vertices << " vertices, at most " << most);
    ASSERT_GE(slices.count(), 1u);
    ASSERT_LE(slices.count(), std::size_t{1} << 16) << "too many to partition at a time";
    ASSERT_LE(slices.entries(), std::max({most, std::uint64_t{4096}, vertices >> 15}));
    ASSERT_EQ((slices.count() - 1) * slices.entries() + slices.size(slices.count() - 1), vertices);
    if (slices.count() > 1) {
      ASSERT_EQ(slices.size(0), slices.entries());
    }
    for (int i = 0; i < 20; ++i) {
      const std::uint64_t id = i == 0 ? vertices - 1 : random.below(vertices);
      ASSERT_LT(slices.slice_of(id), slices.count());
      ASSERT_LT(slices.place_of(id), slices.size(slices.slice_of(id)));
      ASSERT_EQ(slices.slice_of(id) * slices.entries() + slices.place_of(id), id);
    }
  }
}

}  // namespace
}  // namespace reeb::ooc
