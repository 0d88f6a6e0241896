// Whole runs, from a mesh to a `.reeb` file, against the definition of the Reeb graph, for chunks of
// any size, any number of threads and all forms of input (REEB_SEED and REEB_CASES choose which
// complexes and how many; REEB_TEST_MEMORY and REEB_TEST_CHUNK confine the runs).
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include "libreeb/base/error.h"
#include "libreeb/hierarchy/denoise.h"
#include "ooc/compute.h"
#include "ooc/reeb_file.h"
#include "tests/model/reference_reeb.h"
#include "tests/ooc/scratch.h"
#include "tests/support/complex_mesh.h"
#include "tests/support/files.h"
#include "tests/support/random.h"
#include "tests/support/random_complex.h"
#include "tests/support/run_limits.h"
#include "tests/support/seed.h"
#include "tests/support/shapes.h"

namespace reeb::test {
namespace {

enum class Form { kIndexed, kStream, kUnfinalized };
constexpr Form kForms[] = {Form::kIndexed, Form::kStream, Form::kUnfinalized};

const char* name_of(Form form) {
  return form == Form::kIndexed ? "Indexed" : form == Form::kStream ? "Stream" : "Unfinalized";
}

struct RunShape {
  std::size_t chunk_triangles;  // 0: adaptive
  unsigned threads;
  Form form;
};

std::ostream& operator<<(std::ostream& out, const RunShape& shape) {
  return out << "chunk " << shape.chunk_triangles << ", threads " << shape.threads
             << ", " << name_of(shape.form);
}

std::vector<RunShape> all_shapes() {
  std::vector<std::size_t> chunks = {1, 7, 1000, 65536, 0};
  if (const auto limit = chunk_limit()) chunks = {static_cast<std::size_t>(*limit)};
  std::vector<RunShape> shapes;
  for (const std::size_t chunk : chunks)
    for (const unsigned threads : {1u, 2u, 4u})
      for (const Form form : kForms) shapes.push_back({chunk, threads, form});
  return shapes;
}

// A run syncs its output to disk, which would be nearly all that these many small runs wait for:
// where the system has a folder in memory, scratch folders are there.
const bool scratch_is_in_memory =
    ::access("/dev/shm", W_OK) == 0 && ::setenv("TMPDIR", "/dev/shm", /*overwrite=*/0) == 0;

// Runs of `compute` on one mesh; each works in a folder that is empty before and after.
class Runner {
 public:
  explicit Runner(bool graph_only = false) { options_.graph_only = graph_only; }

  // For the runs that follow.
  ooc::ComputeOptions& options() { return options_; }

  // The outputs of the functions that are these columns of the mesh, in one run.
  std::vector<std::string> run(const ComplexMesh& mesh, const RunShape& shape, std::vector<unsigned> columns = {3},
                               std::uint64_t seed = 1) {
    std::vector<ColumnFunction> functions(columns.begin(), columns.end());
    std::vector<VertexFunction*> pointers;
    std::vector<std::string> outputs;
    for (ColumnFunction& function : functions) {
      pointers.push_back(&function);
      outputs.push_back(outputs_.path() + "/" + function.name() + ".reeb");
    }
    ooc::MeshInput input;
    if (shape.form == Form::kStream)
      input.reader = std::make_unique<ComplexStream>(mesh, seed);
    else if (shape.form == Form::kUnfinalized)
      input.reader = std::make_unique<UnfinalizedComplex>(mesh, seed);
    else
      input.indexed = std::make_unique<IndexedComplex>(mesh);
    ooc::ComputeOptions options = options_;
    options.chunk_triangles = shape.chunk_triangles;
    options.threads = shape.threads;
    options.temp_dir = temp_.path();
    options.memory_bytes = memory_limit().value_or(options_.memory_bytes);
    results_ = ooc::compute(std::move(input), pointers, outputs, options);
    EXPECT_TRUE(temp_.empty()) << "temporary files were left";
    return outputs;
  }

  const std::vector<ooc::ComputeResult>& results() const { return results_; }

 private:
  ooc::ComputeOptions options_;
  ooc::Scratch outputs_, temp_;
  std::vector<ooc::ComputeResult> results_;
};

// Reads and removes it.
std::string take_bytes(const std::string& path) {
  std::string bytes = read_file(path);
  std::filesystem::remove(path);
  return bytes;
}

ReebGraph take_graph(const std::string& path) {
  ReebGraph graph = ooc::ReebFile(path).load().graph;
  std::filesystem::remove(path);
  return graph;
}

TEST(Pipeline, EqualsTheDefinitionOnRandomComplexes) {
  const std::uint64_t seed = base_seed(), cases = case_count(10'000);
  const std::vector<RunShape> shapes = all_shapes();
  Runner runner;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const ReebGraph expected = reference_reeb(complex);
    Random random(seed + i);
    // One after another, so that each has its turn, and another at random.
    for (const RunShape& shape : {shapes[i % shapes.size()], shapes[random.below(shapes.size())]}) {
      const ReebGraph graph = take_graph(runner.run(mesh, shape, {3}, random.next())[0]);
      ASSERT_TRUE(without_positions(graph) == without_positions(expected))
          << shape << ", case " << i << "\ngot\n" << describe(graph) << "instead of\n" << describe(expected)
          << describe(complex);
      if (graph.node_count() != 0) {
        ASSERT_EQ(graph.positions, expected.positions) << shape << '\n' << describe(complex);
      }
    }
    const ooc::ComputeResult& result = runner.results()[0];
    ASSERT_EQ(result.vertices, complex.vertex_count());
    ASSERT_EQ(result.triangles, mesh.triangles.size() / 3);
    ASSERT_EQ(result.nodes, expected.node_count());
    ASSERT_EQ(result.arcs, expected.arc_count());
    ASSERT_EQ(result.betti.components, component_count(complex));
    ASSERT_EQ(result.betti.loops, expected.arc_count() - expected.node_count() + component_count(complex));
  }
}

// Guesses about what is complete hold and fail, and the graph is the same.
TEST(Pipeline, RevokesGuessesThatWereWrong) {
  const std::uint64_t seed = base_seed(), cases = case_count(3'000);
  Runner runner(/*graph_only=*/true);
  std::uint64_t guessed = 0, wrong = 0, in_one_pass = 0;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const ReebGraph graph = take_graph(runner.run(mesh, {1 + i % 4, 1, Form::kUnfinalized}, {3}, seed + i)[0]);
    ASSERT_TRUE(without_positions(graph) == without_positions(reference_reeb(complex))) << describe(complex);
    const ooc::ComputeResult& result = runner.results()[0];
    guessed += result.guessed_vertices;
    wrong += result.revoked_guesses != 0;
    in_one_pass += result.guessed_vertices != 0 && result.revoked_guesses == 0;
  }
  EXPECT_GT(guessed, cases);
  EXPECT_GT(wrong, cases / 50);
  EXPECT_GT(in_one_pass, cases / 50);
}

TEST(Pipeline, WritesTheSameBytesHoweverItRuns) {
  const std::uint64_t seed = base_seed(), cases = case_count(300);
  const std::vector<RunShape> shapes = all_shapes();
  for (const bool graph_only : {false, true}) {
    Runner runner(graph_only);
    for (std::uint64_t i = 0; i < (graph_only ? cases / 4 : cases); ++i) {
      const Complex complex = random_complex(seed + i);
      const ComplexMesh mesh(complex);
      runner.options().buckets = 0;
      const std::string expected = take_bytes(runner.run(mesh, shapes[0])[0]);
      for (const RunShape& shape : shapes)
        ASSERT_TRUE(take_bytes(runner.run(mesh, shape, {3}, seed + i)[0]) == expected)
            << shape << ", case " << i << '\n' << describe(complex);
    }
  }
}

TEST(Pipeline, SeveralFunctionsInOneRunEqualSingleRuns) {
  const std::uint64_t seed = base_seed(), cases = case_count(500);
  const std::vector<RunShape> shapes = all_shapes();
  Runner runner;
  runner.options().buckets = 0;  // streams finalize in any order, which an embedding shows
  for (std::uint64_t i = 0; i < cases; ++i) {
    Complex complex = random_complex(seed + i);
    ComplexMesh mesh(complex);
    for (const unsigned f : {1u, 2u}) {
      set_random_values(complex, seed + i + f * cases);
      mesh.add_function(complex.values);
    }
    Random random(seed + i);
    const RunShape& shape = shapes[random.below(shapes.size())];
    std::vector<std::string> together;
    for (const std::string& output : runner.run(mesh, shape, {3, 4, 5}, random.next()))
      together.push_back(take_bytes(output));
    for (const unsigned f : {0u, 1u, 2u})
      ASSERT_TRUE(take_bytes(runner.run(mesh, shape, {3 + f}, random.next())[0]) == together[f])
          << shape << ", function " << f << ", case " << i << '\n' << describe(complex);
  }
}

// Graph, pairs and numbers of levels: all that an embedding does not add.
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

std::uint64_t vertices_in_buckets(const ArcBuckets& buckets) {
  std::uint64_t vertices = 0;
  for (const Bucket& bucket : buckets.buckets) vertices += bucket.count;
  return vertices;
}

TEST(Pipeline, EmbedsEveryVertexOnceWhateverTheRun) {
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
              const ooc::Level all = ooc::ReebFile(output).load();
              ASSERT_EQ(vertices_in_buckets(all.buckets) + all.graph.node_count(), complex.vertex_count())
                  << describe(complex);
              expected = read_file(output);
            }
            ASSERT_TRUE(take_bytes(output) == expected) << describe(complex);
          }
        }
    }
  }
}

// What is removed on the way depends on chunks; with the last pass it is what the definition says.
TEST(Pipeline, RemovesTheNoiseOfTheExactGraphHoweverItRuns) {
  const std::uint64_t seed = base_seed(), cases = case_count(600);
  const std::vector<RunShape> shapes = all_shapes();
  std::uint64_t removed = 0;
  for (const bool graph_only : {false, true}) {
    Runner runner(graph_only);
    for (std::uint64_t i = 0; i < cases; ++i) {
      const Complex complex = random_complex(seed + i);
      const ComplexMesh mesh(complex);
      const ReebGraph exact = reference_reeb(complex);
      Random random(seed + i);
      ooc::ComputeOptions& options = runner.options();
      options.buckets = 0;
      options.denoise = random.unit();
      options.denoise_is_share = random.below(2) == 0;
      double threshold = options.denoise;
      if (options.denoise_is_share && !complex.values.empty()) {
        const auto [min, max] = std::minmax_element(complex.values.begin(), complex.values.end());
        threshold *= *max - *min;
      }
      const Denoised expected = denoise(exact, threshold);
      std::string bytes;
      for (std::uint64_t k = 0; k < 4; ++k) {
        const RunShape& shape = shapes[(i + k * 7) % shapes.size()];
        SCOPED_TRACE(testing::Message() << shape << ", case " << i << ", threshold " << threshold);
        const std::string output = runner.run(mesh, shape, {3}, random.next())[0];
        const ReebGraph graph = ooc::ReebFile(output).load().graph;
        ASSERT_TRUE(without_positions(graph) == without_positions(expected.graph))
            << "got\n" << describe(graph) << "instead of\n" << describe(expected.graph) << describe(complex);
        ASSERT_EQ(runner.results()[0].denoised_pairs, expected.removed.size());
        ASSERT_EQ(runner.results()[0].nodes, expected.graph.node_count());
        ASSERT_EQ(runner.results()[0].arcs, expected.graph.arc_count());
        if (k == 0) bytes = read_file(output);
        ASSERT_TRUE(take_bytes(output) == bytes) << describe(complex);
      }
      removed += expected.removed.size();
    }
  }
  EXPECT_GT(removed, cases / 10);
}

TEST(Pipeline, SaysWhatTheLastPassOfNoiseRemovalNeeds) {
  Complex complex = plateau(700, 700);
  Random random(1);
  for (double& value : complex.values) value = random.unit();
  Runner runner(/*graph_only=*/true);
  // Forks of noise keep each other: nearly all stay until the last pass, which has no room.
  runner.options().denoise = 1e-9;
  runner.options().memory_bytes = 16 << 20;
  if (memory_limit()) GTEST_SKIP() << "REEB_TEST_MEMORY is set";
  try {
    runner.run(ComplexMesh(complex), {0, 2, Form::kIndexed});
    FAIL() << "a graph of this size fits?";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kResource);
    EXPECT_NE(error.hint().find("--memory"), std::string::npos);
  }
}

// Without it, nobody would notice that the least budget no longer reaches the disk.
TEST(Pipeline, SpillsUnderTheLeastBudget) {
  if (!memory_limit()) GTEST_SKIP() << "REEB_TEST_MEMORY is not set";
  Complex complex = plateau(1000, 700);
  Random random(1);
  for (double& value : complex.values) value = random.unit();
  Runner runner(/*graph_only=*/true);
  runner.run(ComplexMesh(complex), {static_cast<std::size_t>(chunk_limit().value_or(0)), 2, Form::kIndexed});
  EXPECT_GT(runner.results()[0].spilled_bytes, 0u);
}

// ---- shapes on which a careless engine is quadratic; their graphs are known

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kScale = 20;  // smaller shapes, since everything is slower
#else
constexpr std::size_t kScale = 1;
#endif
// A quadratic run of this many triangles takes hours, a linear one a fraction of this, even on a busy
// machine.
constexpr double kMostSeconds = 20;

// Of all threads of this process: unlike the time on the wall, others have no part in it.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Shape {
  std::string name;
  Complex complex;
  std::vector<ArcKeys> arcs;  // of its graph
};

SweepKey key_of(const Complex& complex, std::uint64_t vertex) { return {complex.values[vertex], VertexId(vertex)}; }

ArcKeys arc_of(const Complex& complex, std::uint64_t lo, std::uint64_t hi) {
  return {key_of(complex, lo), key_of(complex, hi)};
}

// All of it is one monotone patch: an arc from the first vertex to the last.
Shape one_arc(std::string name, Complex complex) {
  Shape shape{std::move(name), std::move(complex), {}};
  shape.arcs = {arc_of(shape.complex, 0, shape.complex.vertex_count() - 1)};
  return shape;
}

// The rim goes up and down past the hub, which is in the middle: every rim vertex is an extremum.
Shape crown(std::size_t blades) {
  Shape shape{"crown", fan(blades, true), {}};
  for (std::uint64_t v = 1; v <= blades; ++v) {
    shape.complex.values[v] = v % 2 == 0 ? 1 : -1;
    shape.arcs.push_back(v % 2 == 0 ? arc_of(shape.complex, 0, v) : arc_of(shape.complex, v, 0));
  }
  return shape;
}

Shape spine(std::size_t pages) {
  Shape shape{"book", book(pages), {}};
  shape.arcs = {arc_of(shape.complex, 0, 1)};
  for (std::uint64_t page = 2; page < shape.complex.vertex_count(); ++page)
    shape.arcs.push_back(arc_of(shape.complex, 1, page));
  return shape;
}

class LargeShape : public testing::TestWithParam<Form> {
 protected:
  static void check(const Shape& shape) {
    SCOPED_TRACE(shape.name);
    check_mesh(shape, shape.complex);
    check_mesh(shape, shuffled(shape.complex, 1));
  }

 private:
  static void check_mesh(const Shape& shape, const Complex& complex) {
    const ComplexMesh mesh(complex);
    const ReebGraph expected = make_graph(shape.arcs, {});
    Runner runner(/*graph_only=*/true);
    for (const unsigned threads : {1u, 2u}) {
      const RunShape run{static_cast<std::size_t>(chunk_limit().value_or(0)), threads, GetParam()};
      const double start = cpu_seconds();
      const std::string output = runner.run(mesh, run)[0];
      const double seconds = cpu_seconds() - start;
      std::cout << complex.kind << ", " << run << ": " << seconds << " s\n";
      if (!memory_limit()) {
        EXPECT_LT(seconds, kMostSeconds) << complex.kind << ", " << run;
      }
      EXPECT_TRUE(without_positions(take_graph(output)) == expected) << complex.kind << ", " << run;
    }
  }
};

TEST_P(LargeShape, FanWithALowHub) { check(one_arc("closed fan", fan(1'000'000 / kScale, true))); }
TEST_P(LargeShape, OpenFan) { check(one_arc("open fan", fan(1'000'000 / kScale, false))); }
TEST_P(LargeShape, FanWithItsHubInTheMiddle) { check(crown(1'000'000 / kScale)); }
TEST_P(LargeShape, BookWithManyPages) { check(spine(300'000 / kScale)); }
TEST_P(LargeShape, Plateau) { check(one_arc("plateau", plateau(1000, 500 / kScale))); }
TEST_P(LargeShape, TiesAlongTheStream) { check(one_arc("strip", tied_strip(1000, 500 / kScale))); }

INSTANTIATE_TEST_SUITE_P(Forms, LargeShape, testing::ValuesIn(kForms),
                         [](const auto& form) { return std::string(name_of(form.param)); });

}  // namespace
}  // namespace reeb::test
