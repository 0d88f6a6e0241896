// Noise removal in whole runs against its definition (docs/SEMANTICS.md, Noise removal): chunks, the live graph and the
// last pass together remove exactly what removing leaf by leaf removes from the exact graph, whatever the chunks, the
// threads, the form of the input and of the output.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "libreeb/base/error.h"
#include "tests/model/naive_denoise.h"
#include "tests/model/naive_hierarchy.h"
#include "tests/model/reference_pairs.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/inputs/shapes.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"
#include "tests/support/whole_run.h"

namespace reeb::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Threshold {
  double denoise;
  bool is_share;
  double absolute;  // the threshold in units of the function
};

std::ostream& operator<<(std::ostream& out, const Threshold& threshold) {
  return out << "denoise " << threshold.denoise << (threshold.is_share ? " of the range, " : ", ")
             << threshold.absolute;
}

// Computed so that the range of any two doubles does not overflow.
double share_of_range(double share, const Complex& complex) {
  if (complex.values.empty()) return 0;
  const auto [min, max] = std::minmax_element(complex.values.begin(), complex.values.end());
  if (std::isfinite(*max - *min)) return share * (*max - *min);
  return static_cast<double>(share * (static_cast<long double>(*max) - *min));
}

// Thresholds that remove nothing or everything, a persistence that occurs, the number next to it, or any value;
// absolute or as a share.
Threshold random_threshold(const Complex& complex, Random& random) {
  const auto value = [&] { return complex.values.empty() ? 0 : complex.values[random.below(complex.values.size())]; };
  const double tie = std::abs(value() - value());
  const auto absolute = [](double t) { return Threshold{t, false, t}; };
  const auto share = [&](double s) { return Threshold{s, true, share_of_range(s, complex)}; };
  switch (random.below(8)) {
    case 0:
      return absolute(0);
    case 1:
      return absolute(kInfinity);
    case 2:
      return absolute(tie);
    case 3:
      return absolute(std::nextafter(tie, kInfinity));
    case 4:
      return share(1);
    case 5:
      return share(0.125 * static_cast<double>(random.below(8)));  // ties where values are whole numbers
    default:
      return random.chance(50) ? share(random.unit()) : absolute(random.unit());
  }
}

Denoised denoised_by_definition(const ReebGraph& exact, double threshold, Random& random) {
  return exact.node_count() < 40 ? naive_denoise(exact, threshold, random.next()) : denoise_in_rounds(exact, threshold);
}

// Checks that each version of the file is what the definition of denoising and cancelling gives.
void expect_levels(const ooc::ReebFile& file, const ReebGraph& full) {
  const NaiveHierarchy expected = naive_hierarchy(full, reference_pairs(full));
  ASSERT_EQ(file.header().steps + 1, expected.versions.size());
  for (std::uint32_t version = 0; version <= file.header().steps; ++version)
    ASSERT_EQ(without_positions(file.load(version).graph), without_positions(expected.versions[version]))
        << "version " << version;
}

TEST(WholeNoise, RoundsEqualLeafByLeaf) {
  const std::uint64_t seed = base_seed(), cases = case_count(3000);
  std::uint64_t removed = 0;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Random random(seed + i);
    const Complex complex = random_complex(seed + i);
    const ReebGraph exact = reference_reeb(complex);
    if (exact.node_count() >= 60) continue;
    const Threshold threshold = random_threshold(complex, random);
    const Denoised rounds = denoise_in_rounds(exact, threshold.absolute);
    const Denoised naive = naive_denoise(exact, threshold.absolute, random.next());
    ASSERT_EQ(without_positions(rounds.graph), without_positions(naive.graph)) << threshold << '\n' << describe(exact);
    ASSERT_EQ(rounds.removed_pairs, naive.removed_pairs);
    removed += naive.removed_pairs;
  }
  EXPECT_GT(removed, cases / 10);
}

TEST(WholeNoise, GoesAsFromTheExactGraphHoweverItRuns) {
  const std::uint64_t seed = base_seed(), cases = case_count(3000);
  const std::vector<RunShape> shapes = all_shapes();
  std::uint64_t removed = 0;
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const ReebGraph exact = reference_reeb(complex);
    Random random(seed + i);
    const Threshold threshold = random_threshold(complex, random);
    const Denoised expected = denoised_by_definition(exact, threshold.absolute, random);
    removed += expected.removed_pairs;
    for (const bool graph_only : {false, true}) {
      Runner runner(graph_only);
      runner.options().denoise = threshold.denoise;
      runner.options().denoise_is_share = threshold.is_share;
      std::string bytes;
      for (const std::uint32_t buckets : {0u, 0u, 64u}) {
        const RunShape& shape = shapes[random.below(shapes.size())];
        SCOPED_TRACE(testing::Message() << shape << ", case " << i << ", " << threshold << ", buckets " << buckets
                                        << (graph_only ? ", graph only" : ""));
        runner.options().buckets = buckets;
        const std::string output = runner.run(mesh, shape, {3}, random.next())[0];
        const ooc::ReebFile file(output);
        const ReebGraph graph = file.load().graph;
        ASSERT_TRUE(without_positions(graph) == without_positions(expected.graph))
            << "got\n"
            << describe(graph) << "instead of\n"
            << describe(expected.graph) << describe(complex);
        ASSERT_EQ(runner.results()[0].denoised_pairs, expected.removed_pairs);
        ASSERT_EQ(runner.results()[0].nodes, expected.graph.node_count());
        ASSERT_EQ(runner.results()[0].arcs, expected.graph.arc_count());
        ASSERT_EQ(file.header().denoised_pairs, expected.removed_pairs);
        ASSERT_DOUBLE_EQ(file.header().denoise_threshold, threshold.absolute);
        if (!graph_only && graph.node_count() < 25) {
          ASSERT_NO_FATAL_FAILURE(expect_levels(file, expected.graph)) << describe(complex);
        }
        if (buckets != 0) continue;
        if (bytes.empty()) bytes = read_file(output);
        ASSERT_TRUE(read_file(output) == bytes) << describe(complex);
      }
    }
  }
  EXPECT_GT(removed, cases / 10);
}

TEST(WholeNoise, SaysWhatTheLastPassOfNoiseRemovalNeeds) {
  Complex complex = plateau(700, 700);
  Random random(1);
  for (double& value : complex.values) value = random.unit();
  Runner runner(/*graph_only=*/true);
  // A rough function has very many short arcs, though few can be removed.
  runner.options().denoise = 0.1;
  runner.options().memory_bytes = 16 << 20;
  try {
    runner.run(ComplexMesh(complex), {0, 2, Form::kIndexed});
    FAIL() << "a graph of this size fits?";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kResource);
    EXPECT_NE(error.hint().find("--memory"), std::string::npos);
  }
}

}  // namespace
}  // namespace reeb::test
