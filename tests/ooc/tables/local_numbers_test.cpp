#include "ooc/tables/local_numbers.h"

#include <gtest/gtest.h>

#include <unordered_map>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

using test::Random;

std::vector<VertexId> random_vertices(Random& random) {
  // Groups of near ids, a power of two apart, so that vertices compete for entries.
  std::vector<VertexId> vertices;
  const std::uint64_t range = random.between(1, 200), stride = std::uint64_t{1} << random.between(0, 40);
  for (std::uint64_t n = random.between(0, 500); n > 0; --n)
    vertices.emplace_back(random.below(range) * stride + random.below(3));
  return vertices;
}

// One object for all chunks, since nothing is cleared between them.
TEST(LocalNumbers, AreThoseOfAMapChunkByChunk) {
  Random random(test::base_seed());
  LocalNumbers numbers;
  std::vector<VertexId> ids;
  for (std::uint64_t c = test::case_count(3000); c > 0; --c) {
    const auto vertices = random_vertices(random);
    std::unordered_map<std::uint64_t, std::uint32_t> model;
    std::vector<std::uint32_t> expected;
    for (const VertexId v : vertices)
      expected.push_back(model.try_emplace(v.value(), static_cast<std::uint32_t>(model.size())).first->second);

    ids.clear();
    numbers.start(ids, static_cast<std::size_t>(random.between(0, 300)));
    std::vector<std::uint32_t> found(vertices.size());
    const std::size_t half = vertices.size() / 2;
    numbers.number(std::span(vertices).first(half), std::span(found).first(half));
    numbers.number(std::span(vertices).subspan(half), std::span(found).subspan(half));

    ASSERT_EQ(found, expected) << "chunk " << c;
    ASSERT_EQ(ids.size(), model.size());
    for (std::uint32_t i = 0; i < ids.size(); ++i) ASSERT_EQ(model.at(ids[i].value()), i);
  }
}

}  // namespace
}  // namespace reeb::ooc
