// Boxes of noise: many of them, each with many nodes on its faces. What is glued is the graph of the simplices, whether
// noise is removed meanwhile or not, and whether the glue is saved and restored between two layers or not.
#include "libreeb/grid/box_glue.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "libreeb/base/error.h"
#include "tests/libreeb/grid/glued_boxes.h"
#include "tests/model/naive_denoise.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

struct NoiseCase {
  GridShape shape;
  std::vector<double> values;
  BoxCut cut;
};

// A slope with noise on it; a third of the cases is a picture.
NoiseCase noise_case(std::uint64_t seed, std::uint64_t most) {
  Random random(seed);
  NoiseCase made;
  for (auto& size : made.shape) size = random.between(most / 2, most);
  if (seed % 3 == 0) made.shape = {3 * most, 2 * most, 1};
  for (auto& cells : made.cut.cells) cells = static_cast<std::uint32_t>(random.between(2, 4));
  made.cut.options.bucket_exponent = -2;
  const double slope = 0.3 * random.unit();
  made.values.resize(vertices_of(made.shape));
  for (std::size_t v = 0; v < made.values.size(); ++v)
    made.values[v] = slope * position_in(made.shape, v)[0] + random.unit();
  return made;
}

GluedBoxes glue_boxes(const NoiseCase& noise) {
  GluedBoxesSink sink;
  BoxGlue glue(sink);
  for (const Fragment& fragment : fragments_of_boxes(noise.shape, noise.values, noise.cut)) glue.add(fragment);
  EXPECT_EQ(glue.live_vertices(), 0u);
  EXPECT_EQ(glue.live_arcs(), 0u);
  sink.result.removed_pairs = glue.removed_pairs();
  return std::move(sink.result);
}

TEST(BoxGlue, FindsTheGraphOfNoiseInManyBoxes) {
  const std::uint64_t seed = base_seed();
  for (std::uint64_t i = 0; i < case_count(6); ++i) {
    const NoiseCase noise = noise_case(seed + i, 11);
    SCOPED_TRACE(testing::Message() << "seed " << seed + i << ", " << name_of(noise.shape, noise.cut));
    const GluedBoxes glued = glue_boxes(noise);
    const ReebGraph expected = without_positions(reference_reeb(complex_of_grid(noise.shape, noise.values)));
    ASSERT_EQ(describe(glued.graph()), describe(expected));
    ASSERT_EQ(glued.vertices(), noise.values.size());
  }
}

// The pass over the whole graph that follows a run removes the rest.
TEST(BoxGlue, RemovesMostNoiseAndNothingElse) {
  const std::uint64_t seed = base_seed();
  std::uint64_t removed = 0, all = 0;
  for (std::uint64_t i = 0; i < case_count(6); ++i) {
    NoiseCase noise = noise_case(seed + 1000 + i, 10);
    noise.cut.options.noise_below = 0.1 * static_cast<double>(1 + i % 10);
    SCOPED_TRACE(testing::Message() << "seed " << seed + 1000 + i << ", " << name_of(noise.shape, noise.cut));
    const GluedBoxes glued = glue_boxes(noise);
    const ReebGraph whole = without_positions(reference_reeb(complex_of_grid(noise.shape, noise.values)));
    const Denoised expected = naive_denoise(whole, noise.cut.options.noise_below);
    const Denoised rest = naive_denoise(glued.graph(), noise.cut.options.noise_below);
    ASSERT_EQ(describe(rest.graph), describe(expected.graph));
    ASSERT_EQ(glued.removed_pairs + rest.removed_pairs, expected.removed_pairs);
    ASSERT_EQ(glued.vertices(), noise.values.size());
    removed += glued.removed_pairs;
    all += expected.removed_pairs;
  }
  EXPECT_GT(10 * removed, 9 * all);
}

// A range that grows makes buckets wider and the threshold larger, so that saddles which have settled are near noise.
TEST(BoxGlue, StaysExactWhenTheOptionsGrow) {
  const std::uint64_t seed = base_seed();
  for (std::uint64_t i = 0; i < case_count(40); ++i) {
    NoiseCase noise = noise_case(seed + i, 8);
    noise.cut.options.noise_below = 0.01;
    NoiseCase later = noise;
    later.cut.options = {0.5, 1};
    SCOPED_TRACE(testing::Message() << "seed " << seed + i << ", " << name_of(noise.shape, noise.cut));
    const std::vector<Fragment> before = fragments_of_boxes(noise.shape, noise.values, noise.cut);
    const std::vector<Fragment> after = fragments_of_boxes(noise.shape, noise.values, later.cut);
    GluedBoxesSink sink;
    BoxGlue glue(sink);
    for (std::size_t f = 0; f < before.size(); ++f) glue.add(2 * f < before.size() ? before[f] : after[f]);
    const ReebGraph whole = without_positions(reference_reeb(complex_of_grid(noise.shape, noise.values)));
    const Denoised expected = naive_denoise(whole, later.cut.options.noise_below);
    const Denoised rest = naive_denoise(sink.result.graph(), later.cut.options.noise_below);
    ASSERT_EQ(describe(rest.graph), describe(expected.graph));
    ASSERT_EQ(glue.removed_pairs() + rest.removed_pairs, expected.removed_pairs);
    ASSERT_EQ(sink.result.vertices(), noise.values.size());
  }
}

TEST(BoxGlue, TakesNoMoreMemoryThanItSays) {
  for (const double noise_below : {0.0, 0.2}) {
    NoiseCase noise = noise_case(base_seed() + 1, 40);
    noise.cut.cells = {8, 8, 8};
    noise.cut.options.noise_below = noise_below;
    GluedBoxesSink sink;
    BoxGlue glue(sink);
    for (const Fragment& fragment : fragments_of_boxes(noise.shape, noise.values, noise.cut)) {
      const std::size_t most = glue.memory_bytes_with(fragment);
      glue.add(fragment);
      ASSERT_LE(glue.memory_bytes(), most);
    }
  }
}

// ---- saving and restoring

std::size_t boxes_of_a_layer(const NoiseCase& noise) {
  const GridBoxes boxes(noise.shape, noise.cut.cells);
  return boxes.count(0) * (noise.shape[2] == 1 ? 1 : boxes.count(1));
}

TEST(BoxGlue, ContinuesFromASavedState) {
  const std::uint64_t seed = base_seed();
  for (std::uint64_t i = 0; i < case_count(20); ++i) {
    NoiseCase noise = noise_case(seed + i, 10);
    noise.cut.options.noise_below = i % 2 == 0 ? 0.0 : 0.3;
    const GluedBoxes whole = glue_boxes(noise);
    const std::size_t layer = boxes_of_a_layer(noise);
    GluedBoxesSink sink;
    auto glue = std::make_unique<BoxGlue>(sink);
    std::size_t done = 0;
    for (const Fragment& fragment : fragments_of_boxes(noise.shape, noise.values, noise.cut)) {
      glue->add(fragment);
      if (++done % layer != 0) continue;
      StateBytes state;
      glue->save(state);
      const std::size_t live = glue->live_vertices();
      glue = std::make_unique<BoxGlue>(sink);
      glue->restore(state);
      ASSERT_EQ(state.left(), 0u);
      ASSERT_EQ(glue->live_vertices(), live);
      ASSERT_LE(glue->vertex_bound(), noise.values.size());
    }
    SCOPED_TRACE(testing::Message() << "seed " << seed + i << ", " << name_of(noise.shape, noise.cut));
    ASSERT_EQ(describe(sink.result.graph()), describe(whole.graph()));
    ASSERT_EQ(glue->removed_pairs(), whole.removed_pairs);
    ASSERT_EQ(sink.result.vertices(), noise.values.size());
  }
}

// Also says where what was written last begins.
struct NotedBytes : StateBytes {
  std::size_t last = 0;

  void write(std::span<const std::byte> more) override {
    last = bytes().size();
    StateBytes::write(more);
  }
};

// An image can have more vertices than a bucket can count.
TEST(BoxGlue, ContinuesFromBucketsOfMoreThan2To32Vertices) {
  NoiseCase noise = noise_case(base_seed() + 1, 40);
  noise.cut.cells = {8, 8, 8};
  const std::vector<Fragment> fragments = fragments_of_boxes(noise.shape, noise.values, noise.cut);
  GluedBoxesSink sink;
  NotedBytes saved;
  {
    BoxGlue glue(sink);
    for (std::size_t i = 0; i < boxes_of_a_layer(noise); ++i) glue.add(fragments[i]);
    glue.save(saved);
  }
  std::vector<std::byte> bytes = saved.bytes();
  ASSERT_GE(bytes.size() - saved.last, 2 * sizeof(BucketSum));
  for (std::size_t at = saved.last; at < bytes.size(); at += sizeof(BucketSum)) {
    BucketSum bucket;
    std::memcpy(&bucket, bytes.data() + at, sizeof(bucket));
    bucket.count = 3'000'000'000u;
    std::memcpy(bytes.data() + at, &bucket, sizeof(bucket));
  }
  StateBytes state(bytes), again;
  BoxGlue glue(sink);
  glue.restore(state);
  glue.save(again);
  EXPECT_EQ(again.bytes(), bytes);
}

// With other bytes, the boxes that follow make a graph of it, or it is found to be damaged.
TEST(BoxGlue, NeverCrashesOnAForgedState) {
  const std::uint64_t seed = base_seed();
  std::mt19937_64 random(seed);
  const NoiseCase noise = noise_case(seed + 1, 9);
  const std::vector<Fragment> fragments = fragments_of_boxes(noise.shape, noise.values, noise.cut);
  const std::size_t done = boxes_of_a_layer(noise);
  GluedBoxesSink sink;
  StateBytes good;
  {
    BoxGlue glue(sink);
    for (std::size_t i = 0; i < done; ++i) glue.add(fragments[i]);
    glue.save(good);
  }
  std::uint64_t damaged = 0;
  for (std::uint64_t n = 0; n < case_count(2000); ++n) {
    std::vector<std::byte> bytes = good.bytes();
    for (std::uint64_t change = 0; change <= n % 3; ++change) {
      const std::size_t end = random() % 2 == 0 ? std::min<std::size_t>(bytes.size(), 200) : bytes.size();
      const std::size_t at = random() % (end - 8) & ~std::size_t{3};
      const std::uint64_t word = random() % 2 == 0 ? random() : random() % 500;
      if (random() % 3 == 0)
        bytes[at] ^= static_cast<std::byte>(1u << random() % 8);
      else
        std::memcpy(bytes.data() + at, &word, random() % 3 == 0 ? 8 : 4);
    }
    try {
      BoxGlue glue(sink);
      StateBytes bad(std::move(bytes));
      glue.restore(bad);
      for (std::size_t i = done; i < fragments.size(); ++i) glue.add(fragments[i]);
    } catch (const DamagedState&) {
      ++damaged;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kResource) << error.what();  // a bucket has more vertices than it can count
    }
    sink.result = {};
  }
  EXPECT_GT(damaged, 0u);
}

}  // namespace
}  // namespace reeb::test
