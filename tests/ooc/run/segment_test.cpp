// Segmentation against the definition: on small complexes, for chunks of any size, any number of threads, all forms of
// input and all levels.
#include "ooc/run/segment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
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

using Labels = std::vector<ooc::ArcLabel>;

ooc::MeshInput input_of(const ComplexMesh& mesh, Form form, std::uint64_t seed) {
  ooc::MeshInput input;
  if (form == Form::kStream) {
    input.read_again = [&mesh, seed] { return std::make_unique<ComplexStream>(mesh, seed); };
    input.reader = input.read_again();
  } else if (form == Form::kUnfinalized) {
    input.reader = std::make_unique<UnfinalizedComplex>(mesh, seed);
  } else if (form == Form::kPieces) {
    input.indexed = in_random_pieces(mesh, seed);
  } else {
    input.indexed = std::make_unique<IndexedComplex>(mesh);
  }
  return input;
}

struct Segmented {
  Labels labels;
  std::vector<double> values;
  ooc::SegmentCounts counts;
};

Segmented segment(const ComplexMesh& mesh, const RunShape& shape, const ooc::ReebFile& file, std::uint32_t version,
                  std::uint64_t seed = 1) {
  const ooc::Scratch temp;
  ooc::ComputeOptions options;
  options.chunk_triangles = shape.chunk_triangles;
  options.stretch_triangles = shape.stretch_triangles;
  options.threads = shape.threads;
  options.temp_dir = temp.path();
  if (seed % 3 == 0) options.memory_bytes = 24 << 20;
  ColumnFunction function(3);
  const auto segmentation = ooc::segment_mesh(input_of(mesh, shape.form, seed), function,
                                              {.file = file,
                                               .version = version,
                                               .vertex_bound = mesh.vertex_count(),
                                               .output = temp.path() + "/out",
                                               .options = std::move(options)});
  Segmented result;
  result.labels.resize(segmentation->vertex_bound());
  result.values.resize(segmentation->vertex_bound());
  segmentation->read(result.labels, result.values);
  result.counts = segmentation->counts();
  EXPECT_TRUE(temp.empty());
  return result;
}

Labels labels_of(const ReferenceArcs& arcs, std::size_t vertices) {
  Labels labels(vertices, ooc::kDroppedVertex);
  for (std::size_t n = 0; n < arcs.graph.node_count(); ++n)
    labels[arcs.graph.nodes[n].vertex.value()] = -1 - static_cast<ooc::ArcLabel>(n);
  for (std::size_t a = 0; a < arcs.vertices.size(); ++a)
    for (const std::uint64_t vertex : arcs.vertices[a]) labels[vertex] = static_cast<ooc::ArcLabel>(a);
  return labels;
}

std::string text_of(const Labels& labels) {
  std::string text;
  for (const ooc::ArcLabel label : labels) text += std::to_string(label) + ' ';
  return text;
}

// The vertices as points of the graph, by index.
std::vector<PlainGraph::Point> points_of(const ReferenceArcs& arcs, const Complex& complex) {
  std::vector<PlainGraph::Point> points(complex.vertex_count());
  for (std::uint32_t n = 0; n < arcs.graph.node_count(); ++n)
    points[arcs.graph.nodes[n].vertex.value()] = {double(n), 0, 0, true, false};
  std::vector<std::size_t> arc_of(points.size());
  for (std::size_t a = 0; a < arcs.vertices.size(); ++a)
    for (const std::uint64_t vertex : arcs.vertices[a]) arc_of[vertex] = a;
  double place = -1;
  for (const std::uint64_t vertex : sweep_order(complex)) {
    PlainGraph::Point& point = points[vertex];
    if (point.is_node) {
      place = point.place;
      continue;
    }
    place += 0.5 / double(points.size());
    point = {place, arcs.graph.lo[arc_of[vertex]].value(), arcs.graph.hi[arc_of[vertex]].value(), false, false};
  }
  return points;
}

// Compares with the points, which know parallel arcs by their ends only.
void expect_level(const Segmented& result, const std::vector<PlainGraph::Point>& points, const ReebGraph& full,
                  const ReebGraph& level, const Complex& complex) {
  std::vector<std::uint64_t> first(level.arc_count(), ~std::uint64_t{0});  // by arc: its first vertex
  ooc::SegmentCounts counts;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const PlainGraph::Point& point = points[v];
    const ooc::ArcLabel label = result.labels[v];
    SCOPED_TRACE(testing::Message() << "vertex " << v << ": " << label << '\n' << describe(complex) << describe(level));
    if (point.is_dropped) {
      ++counts.dropped;
      ASSERT_EQ(label, ooc::kDroppedVertex);
    } else if (point.is_node) {
      ++counts.nodes;
      ASSERT_LT(label, 0);
      ASSERT_LT(std::size_t(-1 - label), level.node_count());
      ASSERT_EQ(level.nodes[std::size_t(-1 - label)].vertex.value(), v);
    } else {
      ++counts.on_arcs;
      ASSERT_GE(label, 0);
      const auto arc = std::size_t(label);
      ASSERT_LT(arc, level.arc_count());
      ASSERT_EQ(level.nodes[level.lo[arc].value()], full.nodes[point.lo]);
      ASSERT_EQ(level.nodes[level.hi[arc].value()], full.nodes[point.hi]);
      first[arc] = std::min<std::uint64_t>(first[arc], v);
    }
  }
  for (std::size_t a = 1; a < first.size(); ++a)
    if (level.lo[a - 1] == level.lo[a] && level.hi[a - 1] == level.hi[a]) {
      ASSERT_LE(first[a - 1], first[a]);
    }
  EXPECT_EQ(result.counts.on_arcs, counts.on_arcs);
  EXPECT_EQ(result.counts.nodes, counts.nodes);
  EXPECT_EQ(result.counts.dropped, counts.dropped);
}

TEST(Segment, FollowsEveryCancellation) {
  const std::uint64_t seed = base_seed(), cases = case_count(3'000);
  const std::vector<RunShape> shapes = all_shapes();
  Runner runner;
  runner.options().buckets = 0;
  std::uint64_t levels = 0, ambiguous = 0;
  for (std::uint64_t i = 0; i < cases && !testing::Test::HasFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const ReferenceArcs arcs = reference_arcs(complex);
    const NaiveHierarchy naive = naive_hierarchy(arcs.graph, reference_pairs(arcs.graph), points_of(arcs, complex));
    if (naive.steps.empty()) continue;
    Random random(seed + i);
    const auto version = static_cast<std::uint32_t>(1 + random.below(naive.steps.size()));
    if (naive.ambiguous[version]) {
      ++ambiguous;
      continue;
    }
    const std::string output = runner.run(mesh, shapes[i % shapes.size()])[0];
    SCOPED_TRACE(testing::Message() << "case " << i << ", version " << version);
    const Segmented result = segment(mesh, shapes[random.below(shapes.size())], ooc::ReebFile(output), version, i + 1);
    std::filesystem::remove(output);
    ASSERT_NO_FATAL_FAILURE(expect_level(result, naive.points[version], arcs.graph, naive.versions[version], complex));
    ++levels;
  }
  EXPECT_GT(levels, cases / 3);
  EXPECT_LT(ambiguous, levels);
}

TEST(Segment, EqualsTheDefinitionOnRandomComplexes) {
  const std::uint64_t seed = base_seed(), cases = case_count(10'000);
  std::vector<RunShape> shapes = all_shapes();
  shapes.push_back({2, 2, Form::kPieces});
  Runner runner(/*graph_only=*/true);
  runner.options().buckets = 0;
  for (std::uint64_t i = 0; i < cases && !testing::Test::HasFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const std::string output = runner.run(mesh, shapes[i % shapes.size()])[0];
    const Labels expected = labels_of(reference_arcs(complex), complex.vertex_count());
    Random random(seed + i);
    const RunShape& shape = shapes[random.below(shapes.size())];
    const Segmented result = segment(mesh, shape, ooc::ReebFile(output), 0, seed + i);
    std::filesystem::remove(output);
    ASSERT_EQ(result.labels, expected) << "case " << i << ", " << shape << '\n'
                                       << text_of(result.labels) << '\n'
                                       << text_of(expected) << '\n'
                                       << describe(complex);
    for (std::size_t v = 0; v < expected.size(); ++v) ASSERT_EQ(result.values[v], complex.values[v]);
  }
}

// Each vertex of a denoised graph lies on an arc around its value, and none is lost.
TEST(Segment, FollowsTheRemovalOfNoise) {
  const std::uint64_t seed = base_seed(), cases = case_count(1'000);
  const std::vector<RunShape> shapes = all_shapes();
  Runner runner;
  runner.options().buckets = 0;
  runner.options().denoise = 0.3;
  runner.options().denoise_is_share = true;
  std::uint64_t removed = 0;
  for (std::uint64_t i = 0; i < cases && !testing::Test::HasFailure(); ++i) {
    const Complex complex = random_complex(seed + i);
    const ComplexMesh mesh(complex);
    const std::string output = runner.run(mesh, shapes[i % shapes.size()])[0];
    removed += runner.results()[0].denoised_pairs;
    const ooc::ReebFile file(output);
    Random random(seed + i);
    const auto version = static_cast<std::uint32_t>(random.below(file.header().steps + 1));
    const ReebGraph level = file.load(version).graph;
    const RunShape &one = shapes[random.below(shapes.size())], &other = shapes[random.below(shapes.size())];
    const Segmented result = segment(mesh, one, file, version, i + 1);
    ASSERT_EQ(result.labels, segment(mesh, other, file, version, i + 2).labels) << one << " and " << other;
    std::filesystem::remove(output);
    for (std::size_t v = 0; v < result.labels.size(); ++v) {
      const ooc::ArcLabel label = result.labels[v];
      const SweepKey key{complex.values[v], VertexId(v)};
      if (label < 0) {
        if (label != ooc::kDroppedVertex) {
          ASSERT_EQ(level.nodes[std::size_t(-1 - label)], key);
        }
        continue;
      }
      ASSERT_LT(level.nodes[level.lo[std::size_t(label)].value()], key);
      ASSERT_LT(key, level.nodes[level.hi[std::size_t(label)].value()]);
    }
    ASSERT_EQ(result.counts.nodes, level.node_count());
    ASSERT_EQ(result.counts.nodes + result.counts.on_arcs + result.counts.dropped, complex.vertex_count());
    if (version == 0) {
      ASSERT_EQ(result.counts.dropped, 0u);
    }
  }
  EXPECT_GT(removed, cases / 2);
}

// Of the loop from 0 to 3, an arc is taken away, and no other path rises from 0 to 3.
TEST(Segment, DropsTheVerticesOfAnArcWithoutAnotherPath) {
  const Complex complex = make_complex({-100, 0, -101, 1, 2, 100, 3, 101, 1.5},
                                       {{0, 1}, {2, 3}, {1, 8}, {8, 6}, {1, 4}, {3, 4}, {3, 6}, {4, 5}, {6, 7}});
  const ComplexMesh mesh(complex);
  Runner runner;
  const ooc::ReebFile file(runner.run(mesh, {7, 1, Form::kIndexed})[0]);
  EXPECT_EQ(segment(mesh, {2, 1, Form::kStream}, file, 0).labels, (Labels{-2, -3, -1, -4, -5, -7, -6, -8, 3}));
  const Segmented level = segment(mesh, {2, 1, Form::kStream}, file, file.version_at(3.5));
  // What is left: an arc each from 2 up to 3, from 0 and from 3 up to 4, from 4 and from 3 up to a maximum.
  EXPECT_EQ(level.labels, (Labels{-2, 1, -1, -3, -4, -5, 3, -6, ooc::kDroppedVertex}));
  EXPECT_EQ(level.counts.dropped, 1u);
}

TEST(Segment, RefusesAnotherMesh) {
  Runner runner(/*graph_only=*/true);
  const Complex torus = upright_torus(8, 6);
  const ooc::ReebFile file(runner.run(ComplexMesh(torus), {7, 1, Form::kIndexed})[0]);
  const auto expect_refused = [&](const Complex& complex) {
    const ComplexMesh mesh(complex);
    try {
      segment(mesh, {7, 1, Form::kIndexed}, file, 0);
      ADD_FAILURE() << describe(complex);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << error.what();
    }
  };
  Complex other = torus;
  other.simplices.erase(other.simplices.begin() + 5);
  expect_refused(other);
  other = torus;
  other.values[36] = -5;  // the minimum
  expect_refused(other);
  other = torus;
  other.positions.pop_back();
  other.values.pop_back();
  std::erase_if(other.simplices,
                [&](const auto& simplex) { return std::ranges::count(simplex, other.positions.size()) != 0; });
  expect_refused(other);
  expect_refused(upright_torus(9, 6));
}

}  // namespace
}  // namespace reeb::test
