// A grid that is cut into boxes, which are swept and glued: what came out.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "libreeb/grid/box_glue.h"
#include "libreeb/grid/box_sweep.h"
#include "libreeb/grid/grid_boxes.h"
#include "libreeb/port/graph_sink.h"
#include "tests/support/inputs/grid_complex.h"

namespace reeb::test {

struct GluedBoxes {
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

class GluedBoxesSink : public GraphSink {
 public:
  void add_nodes(std::span<const SettledNode> nodes) override {
    for (const SettledNode& node : nodes) result.nodes.push_back(node.key);
  }
  void add_arcs(const SettledArcs& settled) override {
    result.arcs.insert(result.arcs.end(), settled.arcs.begin(), settled.arcs.end());
    std::vector<Bucket> buckets;
    for (std::size_t i = 0; i < settled.lists.ends.size(); ++i) settled.lists.unpack(i, buckets);
    for (const Bucket& bucket : buckets) result.in_buckets += bucket.count;
  }
  GluedBoxes result;
};

struct BoxCut {
  std::array<std::uint32_t, 3> cells;
  SweepOptions options = {};
};

inline std::string name_of(const GridShape& shape, const BoxCut& cut) {
  std::ostringstream text;
  text << "grid " << shape[0] << 'x' << shape[1] << 'x' << shape[2] << ", boxes of " << cut.cells[0] << 'x'
       << cut.cells[1] << 'x' << cut.cells[2];
  return text.str();
}

// The fragments of the boxes, in order.
inline std::vector<Fragment> fragments_of_boxes(const GridShape& shape, const std::vector<double>& values,
                                                const BoxCut& cut) {
  std::vector<Fragment> fragments;
  BoxSweep sweep;
  const GridBoxes boxes(shape, cut.cells);
  Chunk chunk;
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
        sweep.run(chunk, box_values, fragments.emplace_back(), cut.options);
      }
  return fragments;
}

}  // namespace reeb::test
