// A grid that is cut into boxes has the graph of its simplices, however it is cut, and no vertex is lost.
#include "libreeb/grid/box_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>

#include "libreeb/engine/glue.h"
#include "libreeb/grid/grid_boxes.h"
#include "libreeb/port/graph_sink.h"
#include "tests/model/naive_denoise.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/grid_complex.h"
#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

struct Result {
  std::vector<SweepKey> nodes;
  std::vector<ArcKeys> arcs;
  std::uint64_t in_buckets = 0, removed_pairs = 0;

  std::uint64_t vertices() const { return in_buckets + nodes.size(); }
  ReebGraph graph() const {
    const auto has_arc = [&](const SweepKey& node) {
      return std::any_of(arcs.begin(), arcs.end(),
                         [&](const ArcKeys& arc) { return arc.lo == node || arc.hi == node; });
    };
    std::vector<SweepKey> isolated;
    std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(isolated), std::not_fn(has_arc));
    return make_graph(arcs, isolated);
  }
};

class ResultSink : public GraphSink {
 public:
  void add_nodes(std::span<const SettledNode> nodes) override {
    for (const SettledNode& node : nodes) result.nodes.push_back(node.key);
  }
  void add_arcs(const SettledArcs& settled) override {
    result.arcs.insert(result.arcs.end(), settled.arcs.begin(), settled.arcs.end());
    for (const Bucket& bucket : settled.buckets) result.in_buckets += bucket.count;
  }
  Result result;
};

struct Cut {
  std::array<std::uint32_t, 3> cells;
  SweepOptions options = {};
  bool check_live = false;
};

Result sweep_in_boxes(const GridShape& shape, const std::vector<double>& values, const Cut& cut) {
  ResultSink sink;
  Glue glue(sink, true);
  BoxSweep sweep;
  const GridBoxes boxes(shape, cut.cells);
  Chunk chunk;
  Fragment fragment;
  std::vector<double> box_values;
  for (std::uint64_t k = 0; k < boxes.count(2); ++k)
    for (std::uint64_t j = 0; j < boxes.count(1); ++j)
      for (std::uint64_t i = 0; i < boxes.count(0); ++i) {
        boxes.fill({i, j, k}, chunk);
        box_values.clear();
        for (const VertexId v : chunk.ids) {
          box_values.push_back(values[v.value()]);
          chunk.positions.push_back(position_in(shape, v.value()));
        }
        sweep.run(chunk, box_values, fragment, cut.options);
        glue.add(fragment);
        if (cut.check_live) glue.graph().validate();
      }
  EXPECT_EQ(glue.live_vertices(), 0u);
  EXPECT_EQ(glue.live_edges(), 0u);
  EXPECT_EQ(glue.graph().node_count(), 0u);
  sink.result.removed_pairs = glue.removed_pairs();
  return std::move(sink.result);
}

std::string name_of(const GridShape& shape, const Cut& cut) {
  std::ostringstream text;
  text << "grid " << shape[0] << 'x' << shape[1] << 'x' << shape[2] << ", boxes of " << cut.cells[0] << 'x'
       << cut.cells[1] << 'x' << cut.cells[2];
  return text.str();
}

TEST(BoxSweep, FindsTheGraphOfTheSimplices) {
  const std::uint64_t seed = base_seed();
  for (std::uint64_t i = 0; i < case_count(3000); ++i) {
    Random random(seed + i);
    const GridShape shape = random_grid(random);
    const Complex complex = complex_of_grid(shape, random_grid_values(shape, random));
    Cut cut{{}, {}, true};
    for (auto& cells : cut.cells) cells = static_cast<std::uint32_t>(random.between(1, 4));
    cut.options.bucket_exponent = -1;
    const Result result = sweep_in_boxes(shape, complex.values, cut);
    ASSERT_EQ(describe(result.graph()), describe(without_positions(reference_reeb(complex))))
        << "seed " << seed + i << ", " << name_of(shape, cut) << "\n"
        << describe(complex);
    ASSERT_EQ(result.vertices(), complex.vertex_count()) << "seed " << seed + i << ", " << name_of(shape, cut);
  }
}

}  // namespace
}  // namespace reeb::test
