// The numbers of vertices, of which some are left out, against a plain list.
#include "libreeb/port/vertex_numbering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/support/random.h"

namespace reeb {
namespace {

TEST(VertexNumbering, AreThoseOfAPlainList) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    VertexNumbering numbers;
    std::vector<std::uint64_t> plain;
    std::uint64_t next = 0;
    for (std::uint64_t runs = random.below(8); runs-- > 0;) {
      next += random.below(3);
      const std::uint64_t count = random.below(4);
      numbers.append(next, count);
      for (std::uint64_t i = 0; i < count; ++i) plain.push_back(next++);
    }
    ASSERT_EQ(numbers.count(), plain.size());
    EXPECT_EQ(numbers.end(), plain.empty() ? 0 : plain.back() + 1);
    EXPECT_EQ(numbers.has_gaps(), !plain.empty() && plain.back() + 1 != plain.size());
    for (std::uint64_t i = 0; i < plain.size(); ++i) {
      EXPECT_EQ(numbers.number_of(i), plain[i]);
      std::uint64_t end = i + 1;
      while (end < plain.size() && plain[end] == plain[end - 1] + 1) ++end;
      EXPECT_EQ(numbers.run_from(i), end - i);
    }
    for (std::uint64_t number = 0; number < next + 3; ++number) {
      const auto at = std::ranges::find(plain, number);
      const auto index = numbers.index_of(number);
      ASSERT_EQ(index.has_value(), at != plain.end()) << number;
      EXPECT_EQ(index.value_or(0), index ? static_cast<std::uint64_t>(at - plain.begin()) : 0);
    }
  }
}

}  // namespace
}  // namespace reeb
