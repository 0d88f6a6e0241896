#include "io/plot/graph_layout.h"

#include <algorithm>

#include "io/plot/branch_places.h"
#include "io/plot/specks.h"

namespace reeb::io {

std::vector<double> heights(const ReebGraph& graph) {
  std::vector<double> result(graph.node_count(), 0.5);
  if (result.empty()) return result;
  const double low = graph.nodes.front().value / 2, range = graph.nodes.back().value / 2 - low;
  if (!(range > 0)) return result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (graph.nodes[i].value / 2 - low) / range;
  return result;
}

std::vector<PicturePoint> upright_curve(PicturePoint lo, PicturePoint hi, double bend) {
  const double rise = hi.y - lo.y;
  return {lo, {lo.x + bend, lo.y + rise * 0.45}, {hi.x + bend, hi.y - rise * 0.45}, hi};
}

GraphLayout layered_layout(const ReebGraph& graph) {
  const std::vector<double> height = heights(graph);
  const std::vector<std::uint32_t> specks = specks_of(graph);
  const std::vector<double> place = branch_places(graph, height, specks);
  GraphLayout layout;
  double left = 1e300, right = -1e300;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (specks[i] != kNoSpeck) continue;
    left = std::min(left, place[i]);
    right = std::max(right, place[i]);
  }
  for (std::size_t i = 0; i < height.size(); ++i)
    layout.nodes.push_back({right > left ? (place[i] - left) / (right - left) : 0.5, height[i]});
  layout.arcs.reserve(graph.arc_count());
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const bool is_parallel = arc > 0 && graph.lo[arc - 1] == graph.lo[arc] && graph.hi[arc - 1] == graph.hi[arc];
    const double last = is_parallel ? layout.arcs.back()[1].x - layout.arcs.back()[0].x : 0;
    // Parallel arcs bulge to either side in turns.
    const double bend = !is_parallel ? 0 : (last > 0 ? -last : 0.02 - last);
    layout.arcs.push_back(
        upright_curve(layout.nodes[graph.lo[arc].value()], layout.nodes[graph.hi[arc].value()], bend));
  }
  place_specks(graph, specks, layout);
  return layout;
}

}  // namespace reeb::io
