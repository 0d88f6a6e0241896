// The embedding of whole runs: it changes nothing else. It is the same for any number of threads, and for chunks of any
// size, except where a divided bucket leaves a choice (docs/ARCHITECTURE.md, Buckets). Every run of
// tests/support/whole_run.h checks that no vertex is lost.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/inputs/embedding_places.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"
#include "tests/support/whole_run.h"

namespace reeb::test {
namespace {

// Compares graph, pairs and the number of levels: everything that does not depend on an embedding.
void expect_same_but_for_buckets(const std::string& path, const std::string& other) {
  const ooc::ReebFile a(path), b(other);
  ASSERT_EQ(a.load().graph, b.load().graph);
  ASSERT_EQ(a.header().steps, b.header().steps);
  if (a.header().flags.graph_only) return;
  ASSERT_EQ(a.header().pairs, b.header().pairs);
  const auto x = a.pairs(), y = b.pairs();
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_EQ(x[i].lo.key, y[i].lo.key);
    ASSERT_EQ(x[i].hi.key, y[i].hi.key);
    ASSERT_EQ(x[i].type, y[i].type);
    ASSERT_EQ(x[i].kept, y[i].kept);
  }
  for (std::uint32_t version = 0; version <= a.header().steps; version += 1 + a.header().steps / 4)
    ASSERT_EQ(a.load(version).graph, b.load(version).graph);
}

TEST(WholeEmbedding, ChangesNothingElseAndIsTheSameForAnyThreads) {
  const std::uint64_t seed = base_seed(), cases = case_count(400);
  for (const bool graph_only : {false, true}) {
    Runner runner(graph_only), plain(graph_only);
    plain.options().buckets = 0;
    for (std::uint64_t i = 0; i < cases; ++i) {
      const Complex complex = random_complex(seed + i);
      const ComplexMesh mesh(complex);
      Random random(seed + i);
      runner.options().buckets = static_cast<std::uint32_t>(1 + random.below(i % 3 == 0 ? 200 : 4));
      runner.options().denoise = plain.options().denoise = random.below(2) == 0 ? random.unit() : 0;
      const std::string without = plain.run(mesh, {0, 1, Form::kIndexed})[0];
      for (const std::size_t chunk : {std::size_t{7}, std::size_t{0}})
        for (const Form form : kForms) {
          std::string expected;
          for (const unsigned threads : {1u, 2u, 4u}) {
            const RunShape shape{chunk_limit() ? static_cast<std::size_t>(*chunk_limit()) : chunk, threads, form};
            SCOPED_TRACE(testing::Message() << shape << ", case " << i << ", buckets " << runner.options().buckets
                                            << ", denoise " << runner.options().denoise);
            const std::string output = runner.run(mesh, shape, {3}, seed + i)[0];
            if (threads == 1) {
              ASSERT_NO_FATAL_FAILURE(expect_same_but_for_buckets(output, without)) << describe(complex);
              expected = read_file(output);
            }
            ASSERT_TRUE(take_bytes(output) == expected) << describe(complex);
          }
        }
    }
  }
}

TEST(WholeEmbedding, StraysWithinABucketFromChunkingToChunking) {
  const std::uint64_t seed = base_seed(), cases = case_count(3000);
  const std::vector<RunShape> shapes = all_shapes();
  Runner runner(/*graph_only=*/true);
  std::uint64_t embedded = 0;
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    Random random(seed + i);
    runner.options().buckets = static_cast<std::uint32_t>(1 + random.below(i % 2 == 0 ? 100 : 4));
    const std::string whole = runner.run(mesh, {20'000, 1, Form::kIndexed})[0];
    const int exponent = ooc::ReebFile(whole).header().bucket_exponent;
    const ooc::Level expected = ooc::ReebFile(whole).load();
    embedded += vertices_in_buckets(expected.buckets);
    const RunShape& shape = shapes[i % shapes.size()];
    SCOPED_TRACE(testing::Message() << shape << ", case " << i << ", buckets " << runner.options().buckets);
    const ooc::ReebFile file(runner.run(mesh, shape, {3}, random.next())[0]);
    ASSERT_EQ(file.header().bucket_exponent, exponent);
    const double size = 1 + static_cast<double>(complex.vertex_count());  // the third coordinate is the index
    ASSERT_NO_FATAL_FAILURE(expect_same_places(file.load(), expected, exponent, size)) << describe(complex);
  }
  EXPECT_GT(embedded, cases);
}

}  // namespace
}  // namespace reeb::test
