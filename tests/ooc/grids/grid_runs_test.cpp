// Whole runs on grids: their results are those of the same simplices, written out.
#include <gtest/gtest.h>

#include <atomic>

#include <limits>
#include <memory>

#include "io/functions/function_source.h"
#include "io/grids/grid_mesh.h"
#include "ooc/checkpoints/partial_folder.h"
#include "ooc/chunks/function_values.h"
#include "ooc/grids/grid_layers.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/embedding_places.h"
#include "tests/support/inputs/memory_grid.h"
#include "tests/support/seed.h"
#include "tests/support/whole_run.h"

namespace reeb::test {
namespace {

struct GridRun {
  ooc::ComputeOptions options = {};
  std::string path = "-";  // of a file that stands for the grid
  bool skips = false;
  std::string function = "value";
};

// Computes into `folder`, and returns the output.
std::string run_grid(const GridShape& shape, const std::vector<double>& values, const GridRun& run,
                     const ooc::Scratch& folder, ooc::ComputeResult* result = nullptr) {
  ReadOptions reading;
  reading.batch_events = 1 + values.size() % 7;
  const io::FunctionSpec spec = io::parse_function(run.function);
  reading.properties = io::needed_properties({&spec, 1});
  ooc::MeshInput input;
  input.path = run.path;
  input.reader = io::make_grid_mesh(std::make_unique<MemoryGrid>(shape, values), reading, {run.skips, false});
  input.dimension = input.reader->info().dimension;
  io::FunctionSource function(spec, input.reader->info(), reading.properties);
  VertexFunction* const pointer = &function;
  const std::string output = folder.path() + "/grid.reeb";
  auto results = ooc::compute(std::move(input), {&pointer, 1}, {&output, 1}, run.options);
  if (result != nullptr) *result = results.front();
  return output;
}

// Takes the values of some vertices away: of each with the same chance, or of all but a ball.
void make_gaps(const GridShape& shape, Random& random, std::vector<double>& values) {
  const bool is_ball = random.chance(30);
  const auto missing = static_cast<unsigned>(random.below(50));
  const Point center = position_in(shape, random.below(values.size()));
  for (std::size_t v = 0; v < values.size(); ++v) {
    const Point at = position_in(shape, v);
    const double x = at[0] - center[0], y = at[1] - center[1], z = at[2] - center[2];
    if (is_ball ? x * x + y * y + z * z > 30 : random.chance(missing))
      values[v] = std::numeric_limits<double>::quiet_NaN();
  }
}

GridRun random_run(Random& random) {
  GridRun run;
  const std::size_t sizes[] = {1, 8, 27, 100, 0};
  run.options.chunk_triangles = sizes[random.below(5)];
  run.options.threads = static_cast<unsigned>(random.between(1, 3));
  return run;
}

TEST(GridRuns, HaveTheGraphOfTheSimplices) {
  const std::uint64_t seed = base_seed();
  const ooc::Scratch folder;
  for (std::uint64_t i = 0; i < case_count(600); ++i) {
    Random random(seed + i);
    const GridShape shape = random_grid(random);
    const Complex complex = complex_of_grid(shape, random_grid_values(shape, random));
    const GridRun run = random_run(random);
    ooc::ComputeResult result;
    const std::string output = run_grid(shape, complex.values, run, folder, &result);
    {
      const ooc::ReebFile file(output);
      ASSERT_EQ(describe(without_positions(file.load().graph)), describe(without_positions(reference_reeb(complex))))
          << "seed " << seed + i << "\n"
          << describe(complex);
      expect_vertices_conserved(file);
      file.verify();
    }
    SimplexCounts counts{};
    for (const auto& simplex : complex.simplices) ++counts[simplex.size() - 1];
    EXPECT_EQ(result.simplices, counts);
    EXPECT_EQ(result.vertices, complex.vertex_count());
    ASSERT_FALSE(HasFailure()) << "seed " << seed + i;
    std::filesystem::remove(output);
  }
}

// What is left is compared with its own vertices only, under their indices in the grid.
TEST(GridRuns, SkipVerticesWithoutDataWithTheirSimplices) {
  const std::uint64_t seed = base_seed();
  const ooc::Scratch folder;
  for (std::uint64_t i = 0; i < case_count(600); ++i) {
    Random random(seed + i);
    const GridShape shape = random_grid(random);
    std::vector<double> values = random_grid_values(shape, random);
    const auto missing = static_cast<unsigned>(random.below(70));
    std::vector<bool> present(values.size(), true);
    Complex left;
    std::vector<std::uint64_t> number(values.size()), index;
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (random.chance(missing)) {
        present[v] = false;
        values[v] = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      number[v] = index.size();
      index.push_back(v);
      left.positions.push_back(position_in(shape, v));
    }
    for (auto simplex : simplices_of_grid(shape, present)) {
      for (std::uint64_t& v : simplex) v = number[v];
      left.simplices.push_back(simplex);
    }
    GridRun run = random_run(random);
    run.skips = true;
    run.function = random.chance(50) ? "value" : "x";
    for (const std::uint64_t v : index)
      left.values.push_back(run.function == "x" ? position_in(shape, v)[0] : values[v]);
    ooc::ComputeResult result;
    const std::string output = run_grid(shape, values, run, folder, &result);
    SimplexCounts counts{};
    for (const auto& simplex : left.simplices) ++counts[simplex.size() - 1];
    EXPECT_EQ(result.simplices, counts);
    EXPECT_EQ(result.vertices, index.size());
    {
      const ooc::ReebFile file(output);
      ReebGraph expected = without_positions(reference_reeb(left));
      for (SweepKey& node : expected.nodes) node.vertex = VertexId(index[node.vertex.value()]);
      ASSERT_EQ(describe(without_positions(file.load().graph)), describe(expected)) << "seed " << seed + i;
      expect_vertices_conserved(file);
      file.verify();
    }
    ASSERT_FALSE(HasFailure()) << "seed " << seed + i;
    std::filesystem::remove(output);
  }
}

// An interrupted run is resumed after a layer, not between the boxes of one.
// The bytes of a slice, of all functions, are 2^63 and 2^64.
TEST(GridLayers, OfAHugeHeaderAreRefused) {
  const GridShape shape = {std::uint64_t{1} << 55, 2, 1};
  const io::FunctionSpec spec = io::parse_function("value");
  ReadOptions reading;
  reading.properties = io::needed_properties({&spec, 1});
  const auto reader = io::make_grid_mesh(std::make_unique<MemoryGrid>(shape, std::vector<double>(8)), reading, {});
  io::FunctionSource function(spec, reader->info(), reading.properties);
  for (const std::size_t count : {32u, 64u}) {
    const std::vector<VertexFunction*> functions(count, &function);
    ooc::FunctionValues values(functions, reader->info().dimension);
    MemoryBudget budget(std::uint64_t{1} << 30);
    try {
      ooc::GridLayers(*reader, values, budget, 64, {});
      ADD_FAILURE() << count << " functions";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kResource) << error.what();
    }
  }
}

TEST(GridRuns, AreResumedAsIfNothingHadHappened) {
  const std::uint64_t seed = base_seed();
  const ooc::Scratch folder;
  const std::string mesh = folder.path() + "/grid.raw";
  write_file(mesh, "not read");
  const std::uint64_t cases = case_count(40);
  std::uint64_t interruptions = 0;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Random random(seed + i);
    const GridShape shape{random.between(3, 7), random.between(3, 7), random.between(3, 9)};
    std::vector<double> values = random_grid_values(shape, random);
    GridRun run;
    run.path = mesh;
    run.skips = i % 2 == 1;
    if (run.skips) make_gaps(shape, random, values);
    run.options.chunk_triangles = 8;
    const std::string whole = take_bytes(run_grid(shape, values, run, folder));
    run.options.checkpoint_seconds = 0;
    run.options.replace = false;
    std::atomic<std::uint64_t> polls = 0;  // of several threads
    const std::uint64_t last = random.between(3, 40);
    run.options.interrupted = [&] { return ++polls > last; };
    bool interrupted = false;
    try {
      run_grid(shape, values, run, folder);
    } catch (const Error& error) {
      interrupted = true;
      ++interruptions;
      ASSERT_EQ(error.kind(), ErrorKind::kInterrupted) << error.what();
    }
    run.options.interrupted = {};
    run.options.resume = interrupted;
    // A checkpoint says which boxes the run began with.
    if (ooc::PartialFolder::has_checkpoint(folder.path() + "/grid.reeb") && random.chance(50))
      run.options.chunk_triangles = 200;
    if (interrupted) run_grid(shape, values, run, folder);
    ASSERT_EQ(take_bytes(folder.path() + "/grid.reeb"), whole) << "seed " << seed + i << ", " << interrupted;
  }
  EXPECT_GE(interruptions, cases / 10);
}

// Noise in many boxes, so that most arcs are cut when boxes are joined.
TEST(GridRuns, EmbedWithinABucketFromBoxesToBoxes) {
  const std::uint64_t seed = base_seed();
  const ooc::Scratch folder;
  for (std::uint64_t i = 0; i < case_count(60); ++i) {
    Random random(seed + i);
    GridShape shape{random.between(5, 20), random.between(5, 20), random.between(5, 20)};
    if (i % 4 == 0) shape = {60, 50, 1};
    std::vector<double> values(vertices_of(shape));
    const double slope = random.chance(50) ? 0 : random.unit();
    for (std::size_t v = 0; v < values.size(); ++v) values[v] = slope * position_in(shape, v)[1] + random.unit();
    GridRun run;
    run.skips = i % 3 == 1;
    if (run.skips) make_gaps(shape, random, values);
    run.options.graph_only = true;
    run.options.buckets = static_cast<std::uint32_t>(1 + random.below(i % 2 == 0 ? 100 : 4));
    const ooc::ComputeOptions whole_options = run.options;
    ooc::Level expected, found;
    int exponent = 0;
    for (const std::size_t size : {std::size_t{1'000'000}, std::size_t{8 + random.below(100)}}) {
      run.options = whole_options;
      run.options.chunk_triangles = size;
      run.options.threads = static_cast<unsigned>(random.between(1, 3));
      const std::string output = run_grid(shape, values, run, folder);
      {
        const ooc::ReebFile file(output);
        expect_vertices_conserved(file);
        exponent = file.header().bucket_exponent;
        (size == 1'000'000 ? expected : found) = file.load();
      }
      std::filesystem::remove(output);
    }
    SCOPED_TRACE(testing::Message() << "seed " << seed + i);
    ASSERT_NO_FATAL_FAILURE(expect_same_places(expected, found, exponent, 100));
  }
}

// Noise that is removed does not depend on where boxes end.
TEST(GridRuns, RemoveTheSameNoiseBesideGaps) {
  const std::uint64_t seed = base_seed();
  const ooc::Scratch folder;
  for (std::uint64_t i = 0; i < case_count(100); ++i) {
    Random random(seed + i);
    const GridShape shape{random.between(2, 12), random.between(2, 12), random.between(1, 12)};
    std::vector<double> values = random_grid_values(shape, random);
    make_gaps(shape, random, values);
    GridRun run;
    run.skips = true;
    run.options.denoise = 0.05 * static_cast<double>(random.between(1, 8));
    run.options.denoise_is_share = true;
    std::string expected;
    for (const std::size_t size : {1'000'000u, 12u, 100u, 400u}) {
      run.options.chunk_triangles = size;
      const std::string output = run_grid(shape, values, run, folder);
      const ooc::ReebFile file(output);
      const std::string found =
          describe(without_positions(file.load().graph)) + std::to_string(file.header().denoised_pairs);
      if (expected.empty()) expected = found;
      ASSERT_EQ(found, expected) << "seed " << seed + i << ", boxes of " << size;
      std::filesystem::remove(output);
    }
  }
}

// The same volume as tetrahedra, with noise removed.
TEST(GridRuns, RemoveTheSameNoiseAsRunsOnTetrahedra) {
  const std::uint64_t seed = base_seed();
  const ooc::Scratch folder;
  Runner runner;
  for (std::uint64_t i = 0; i < case_count(60); ++i) {
    Random random(seed + i);
    const GridShape shape{random.between(2, 9), random.between(2, 9), random.between(2, 9)};
    const Complex complex = complex_of_grid(shape, random_grid_values(shape, random));
    GridRun run = random_run(random);
    run.options.denoise = runner.options().denoise = 0.05 * static_cast<double>(random.between(1, 8));
    run.options.denoise_is_share = runner.options().denoise_is_share = true;
    const std::string output = run_grid(shape, complex.values, run, folder);
    const ComplexMesh mesh(complex);
    runner.run(mesh, {0, 1, Form::kIndexed});
    const ooc::ReebFile file(output), other(runner.output(3));
    ASSERT_EQ(describe(without_positions(file.load().graph)), describe(without_positions(other.load().graph)))
        << "seed " << seed + i;
    EXPECT_EQ(file.header().denoised_pairs, other.header().denoised_pairs);
    expect_vertices_conserved(file);
    ASSERT_FALSE(HasFailure()) << "seed " << seed + i;
    std::filesystem::remove(output);
    std::filesystem::remove(runner.output(3));
  }
}

}  // namespace
}  // namespace reeb::test
