#include "libreeb/containers/kept_ids.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace reeb {
namespace {

TEST(KeptIds, RanksAreThoseOfASet) {
  for (const std::uint32_t size : {0u, 1u, 63u, 64u, 65u, 1000u}) {
    SCOPED_TRACE(size);
    std::mt19937_64 random(size);
    KeptIds ids(size);
    std::set<std::uint32_t> model;
    for (std::uint32_t id = 0; id < size; ++id) model.insert(id);
    for (int round = 0; round < 6; ++round) {
      ASSERT_EQ(ids.count(), model.size());
      std::uint32_t rank = 0;
      for (std::uint32_t id = 0; id < size; ++id) {
        ASSERT_EQ(ids.has(id), model.contains(id));
        ASSERT_EQ(ids.rank(id), rank);
        rank += ids.has(id) ? 1u : 0u;
      }
      std::set<std::uint32_t> left;
      auto next = model.begin();
      std::uint32_t old_rank = 0;
      ids.keep_if([&](std::uint32_t id) {
        EXPECT_EQ(id, *next++);
        EXPECT_EQ(ids.rank(id), old_rank++) << "the old rank while it is asked for";
        if (random() % 3 == 0) return false;
        left.insert(id);
        return true;
      });
      EXPECT_EQ(next, model.end());
      model = left;
    }
  }
}

}  // namespace
}  // namespace reeb
