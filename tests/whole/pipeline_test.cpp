// Whole runs, from a mesh to a `.reeb` file, against the definition of the Reeb graph (REEB_SEED and
// REEB_CASES choose which complexes and how many).
#include <gtest/gtest.h>

#include <ctime>
#include <string>

#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/inputs/shapes.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"
#include "tests/support/whole_run.h"

namespace reeb::test {
namespace {

void expect_graph(const ReebGraph& graph, const ReebGraph& expected, const Complex& complex) {
  ASSERT_TRUE(without_positions(graph) == without_positions(expected)) << "got\n"
                                                                       << describe(graph) << "instead of\n"
                                                                       << describe(expected) << describe(complex);
  if (graph.node_count() != 0) {
    ASSERT_EQ(graph.positions, expected.positions) << describe(complex);
  }
}

TEST(Pipeline, EqualsTheDefinitionOnRandomComplexes) {
  const std::uint64_t seed = base_seed(), cases = case_count(10'000);
  const std::vector<RunShape> shapes = all_shapes();
  Runner runner;
  for (std::uint64_t i = 0; i < cases && !testing::Test::HasFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const ReebGraph expected = reference_reeb(complex);
    Random random(seed + i);
    SCOPED_TRACE(testing::Message() << "case " << i);
    // With an embedding: in one shape after another. Without: in two shapes, one of them random; both give the same
    // bytes.
    const RunShape &embedded = shapes[i % shapes.size()], &one = shapes[(i / 2) % shapes.size()],
                   &other = shapes[random.below(shapes.size())];
    const auto run = [&](const RunShape& shape, std::uint32_t buckets) {
      runner.options().buckets = buckets;
      return runner.run(mesh, shape, {3}, random.next())[0];
    };
    ASSERT_NO_FATAL_FAILURE(expect_graph(take_graph(run(embedded, 64)), expected, complex)) << embedded;
    const std::string output = run(one, 0);
    ASSERT_NO_FATAL_FAILURE(expect_graph(ooc::ReebFile(output).load().graph, expected, complex)) << one;
    const std::string bytes = take_bytes(output);
    ASSERT_TRUE(take_bytes(run(other, 0)) == bytes) << one << " and " << other << '\n' << describe(complex);

    const ooc::ComputeResult& result = runner.results()[0];
    ASSERT_EQ(result.vertices, complex.vertex_count());
    ASSERT_EQ(result.simplices, mesh.counts);
    ASSERT_EQ(result.nodes, expected.node_count());
    ASSERT_EQ(result.arcs, expected.arc_count());
    ASSERT_EQ(result.betti.components, component_count(complex));
    ASSERT_EQ(result.betti.loops, expected.arc_count() - expected.node_count() + component_count(complex));
  }
}

// Whether the guesses about complete vertices hold or fail, the graph is the same.
void expect_revoked_guesses(Form form) {
  const std::uint64_t seed = base_seed(), cases = case_count(2'000);
  Runner runner(/*graph_only=*/true);
  std::uint64_t guessed = 0, wrong = 0, in_one_pass = 0;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const ReebGraph graph = take_graph(runner.run(mesh, {1 + i % 4, 1, form}, {3}, seed + i)[0]);
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

TEST(Pipeline, RevokesGuessesThatWereWrong) { expect_revoked_guesses(Form::kUnfinalized); }
TEST(Pipeline, RevokesGuessesThatWereWrongOfAMeshInPlace) { expect_revoked_guesses(Form::kSeeminglyClosed); }

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
            << shape << ", case " << i << '\n'
            << describe(complex);
    }
  }
}

// Pieces of any lengths in any order.
TEST(Pipeline, PiecesInAnyOrderGiveTheSameBytes) {
  const std::uint64_t seed = base_seed(), cases = case_count(2'000);
  Runner runner;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const std::vector<std::size_t> chunks = all_chunk_sizes();
    RunShape shape{chunks[i % chunks.size()], static_cast<unsigned>(1 + i % 3), Form::kPieces};
    if (i % 4 == 0 && shape.chunk_triangles != 0 && shape.chunk_triangles <= 7)
      shape.stretch_triangles = 20 * shape.chunk_triangles;
    runner.options().buckets = 64;
    ASSERT_NO_FATAL_FAILURE(
        expect_graph(take_graph(runner.run(mesh, shape, {3}, i)[0]), reference_reeb(complex), complex))
        << shape;
    runner.options().buckets = 0;
    const std::string expected = take_bytes(runner.run(mesh, {shape.chunk_triangles, 1, Form::kIndexed})[0]);
    ASSERT_TRUE(take_bytes(runner.run(mesh, shape, {3}, i)[0]) == expected) << shape << '\n' << describe(complex);
  }
}

// With an embedding and noise removal for each function, by its own range.
TEST(Pipeline, SeveralFunctionsInOneRunEqualSingleRuns) {
  const std::uint64_t seed = base_seed(), cases = case_count(500);
  const std::vector<RunShape> shapes = all_shapes();
  Runner runner;
  std::uint64_t removed = 0;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Complex complex = random_complex(seed + i);
    ComplexMesh mesh(complex);
    for (const unsigned f : {1u, 2u}) {
      set_random_values(complex, seed + i + f * cases);
      mesh.add_function(complex.values);
    }
    Random random(seed + i);
    const RunShape& shape = shapes[random.below(shapes.size())];
    const std::uint64_t stream = random.next();  // one for all, since an embedding shows how the stream finalizes
    runner.options().buckets = random.chance(70) ? 1 + static_cast<std::uint32_t>(random.below(100)) : 0;
    runner.options().denoise = random.chance(70) ? random.unit() : 0;
    runner.options().denoise_is_share = random.chance(70);
    std::vector<std::string> together;
    for (const std::string& output : runner.run(mesh, shape, {3, 4, 5}, stream)) together.push_back(take_bytes(output));
    for (const ooc::ComputeResult& result : runner.results()) removed += result.denoised_pairs;
    for (const unsigned f : {0u, 1u, 2u})
      ASSERT_TRUE(take_bytes(runner.run(mesh, shape, {3 + f}, stream)[0]) == together[f])
          << shape << ", function " << f << ", case " << i << '\n'
          << describe(complex);
  }
  EXPECT_GT(removed, cases / 10);
}

class CountingMesh : public IndexedComplex {
 public:
  CountingMesh(const ComplexMesh& mesh, std::uint64_t& triangles, std::uint64_t& vertices)
      : IndexedComplex(mesh), triangles_(triangles), vertices_(vertices) {}
  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    const bool more = IndexedComplex::read(corners, limit);
    triangles_ += corners.size() / 3;
    return more;
  }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    vertices_ += ids.size();
    IndexedComplex::gather(ids, columns, values);
  }

 private:
  std::uint64_t &triangles_, &vertices_;
};

TEST(Pipeline, ReadsTheMeshForAllFunctionsTogether) {
  const Complex complex = closed_surface(2, 30, 20);
  ComplexMesh mesh(complex);
  mesh.add_function(complex.values);
  const auto read = [&](std::span<VertexFunction* const> functions) {
    const ooc::Scratch scratch;
    const std::string outputs[] = {scratch.path() + "/a.reeb", scratch.path() + "/b.reeb"};
    std::uint64_t triangles = 0, vertices = 0;
    ooc::MeshInput input;
    input.indexed = std::make_unique<CountingMesh>(mesh, triangles, vertices);
    ooc::ComputeOptions options;
    options.chunk_triangles = 100;
    options.temp_dir = scratch.path();
    ooc::compute(std::move(input), functions, std::span(outputs).first(functions.size()), options);
    EXPECT_EQ(triangles, 2 * mesh.triangles.size() / 3) << "for the last uses, and for the chunks";
    return vertices;
  };
  ColumnFunction height(2), value(3);
  VertexFunction* const both[] = {&height, &value};
  const std::uint64_t vertices = read(std::span(both).first(1));
  EXPECT_GE(vertices, mesh.vertex_count());
  EXPECT_EQ(read(both), vertices);
}

// Without this test, it would go unnoticed if runs with the smallest budget no longer spilled to disk.
TEST(Pipeline, SpillsUnderTheLeastBudget) {
  Complex complex = plateau(1000, 700);
  Random random(1);
  for (double& value : complex.values) value = random.unit();
  Runner runner(/*graph_only=*/true);
  runner.options().memory_bytes = 16 << 20;
  runner.run(ComplexMesh(complex), {static_cast<std::size_t>(chunk_limit().value_or(7)), 2, Form::kIndexed});
  EXPECT_GT(runner.results()[0].spilled_bytes, 0u);
}

// ---- shapes on which a careless engine is quadratic; their graphs are known

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kScale = 20;  // smaller shapes, since everything is slower
#else
constexpr std::size_t kScale = 1;
#endif
// A quadratic run of this many triangles takes hours, a linear one a fraction of this limit, even on a busy machine.
constexpr double kSecondsLimit = 20;

// The processor time of all threads of this process: unlike wall time, it does not depend on other processes.
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

// The whole complex is one monotone patch: an arc from the first vertex to the last.
Shape one_arc(std::string name, Complex complex) {
  Shape shape{std::move(name), std::move(complex), {}};
  shape.arcs = {arc_of(shape.complex, 0, shape.complex.vertex_count() - 1)};
  return shape;
}

// The rim goes up and down past the value of the hub: every rim vertex is an extremum.
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

// Edges only, no triangle.
Shape star(std::size_t edges) {
  Complex complex;
  complex.positions.resize(edges + 1);
  complex.values.resize(edges + 1);
  for (std::uint64_t v = 1; v <= edges; ++v) complex.simplices.push_back({0, v});
  complex.kind = "star of loose edges";
  Shape shape{"star", std::move(complex), {}};
  for (std::uint64_t v = 1; v <= edges; ++v) {
    shape.complex.values[v] = v % 2 == 0 ? 1 : -1;
    shape.arcs.push_back(v % 2 == 0 ? arc_of(shape.complex, 0, v) : arc_of(shape.complex, v, 0));
  }
  return shape;
}

// One triangle many times, its corners in every order, and its edges as degenerate triangles.
Shape repeats(std::size_t times) {
  Complex complex = make_complex({0, 1, 2}, {});
  const std::vector<std::uint64_t> simplices[] = {{0, 1, 2}, {2, 0, 1}, {1, 0, 2}, {0, 2, 0}, {1, 1, 2}, {1, 0}, {2}};
  for (std::size_t i = 0; i < times; ++i) complex.simplices.push_back(simplices[i % std::size(simplices)]);
  complex.kind = "repeats of a triangle";
  return one_arc("repeats", std::move(complex));
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
        EXPECT_LT(seconds, kSecondsLimit) << complex.kind << ", " << run;
      }
      EXPECT_TRUE(without_positions(take_graph(output)) == expected) << complex.kind << ", " << run;
    }
  }
};

TEST_P(LargeShape, FanWithALowHub) { check(one_arc("closed fan", fan(250'000 / kScale, true))); }
TEST_P(LargeShape, OpenFan) { check(one_arc("open fan", fan(250'000 / kScale, false))); }
TEST_P(LargeShape, FanWithItsHubInTheMiddle) { check(crown(250'000 / kScale)); }
TEST_P(LargeShape, BookWithManyPages) { check(spine(100'000 / kScale)); }
TEST_P(LargeShape, StarOfLooseEdges) { check(star(250'000 / kScale)); }
TEST_P(LargeShape, RepeatsOfATriangle) { check(repeats(250'000 / kScale)); }
TEST_P(LargeShape, Plateau) { check(one_arc("plateau", plateau(1000, 500 / kScale))); }
TEST_P(LargeShape, TiesAlongTheStream) { check(one_arc("strip", tied_strip(1000, 500 / kScale))); }

// A stream in any order is run within the budget; it is read again if necessary.
TEST(Pipeline, SortsAStreamOfWhichTooMuchIsLive) {
  const Shape shape = one_arc("plateau", plateau(400, 100));
  const ComplexMesh mesh(shuffled(shape.complex, 1));
  Runner runner(/*graph_only=*/true);
  runner.options().memory_bytes = 16 << 20;
  for (const unsigned threads : {1u, 2u}) {
    const ReebGraph graph = take_graph(runner.run(mesh, {0, threads, Form::kStream})[0]);
    EXPECT_TRUE(without_positions(graph) == make_graph(shape.arcs, {}));
    const ooc::ComputeResult& result = runner.results()[0];
    EXPECT_TRUE(result.reordered);
    ASSERT_FALSE(result.notes.empty());
    EXPECT_NE(result.notes[0].find("read again"), std::string::npos) << result.notes[0];
    EXPECT_EQ(result.simplices, mesh.counts);
  }
  // If sorting is not allowed, the run ends with an error that says how much memory it needs.
  runner.options().may_reorder = false;
  EXPECT_THROW(runner.run(mesh, {0, 2, Form::kStream}), Error);
}

INSTANTIATE_TEST_SUITE_P(Forms, LargeShape, testing::ValuesIn(kForms),
                         [](const auto& form) { return std::string(name_of(form.param)); });

}  // namespace
}  // namespace reeb::test
