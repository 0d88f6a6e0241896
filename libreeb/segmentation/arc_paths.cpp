#include "libreeb/segmentation/arc_paths.h"

#include <algorithm>
#include <functional>

#include "libreeb/segmentation/arc_chains.h"

namespace reeb {

ArcPaths::ArcPaths(const ReebGraph& graph)
    : graph_(graph),
      first_arc_(graph.node_count() + 1),
      highest_(highest_above(graph)),
      reached_(graph.node_count()),
      leads_(graph.node_count()),
      spans_(graph.node_count()),
      doubtful_(graph.arc_count()) {
  std::uint32_t arc = 0;
  for (std::uint32_t n = 0; n < first_arc_.size(); ++n) {
    while (arc < graph.arc_count() && graph.lo[arc].value() < n) ++arc;
    first_arc_[n] = arc;
  }
}

bool ArcPaths::find(NodeId from_node, NodeId to_node, std::vector<ArcId>& path) {
  path.clear();
  const std::uint32_t from = from_node.value(), to = to_node.value();
  if (from == to) return true;
  if (from > to) return false;
  if (++search_ == 0) {  // the numbers of searches are used up
    std::ranges::fill(reached_, 0);
    std::ranges::fill(leads_, 0);
    ++search_;
  }
  nodes_.assign(1, from);
  reached_[from] = search_;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    for (std::uint32_t a = first_arc_[nodes_[i]]; a < first_arc_[nodes_[i] + 1]; ++a) {
      const std::uint32_t above = graph_.hi[a].value();
      if (above > to || highest_[above] < to_node || reached_[above] == search_) continue;
      reached_[above] = search_;
      nodes_.push_back(above);
    }
    if (nodes_.size() > kMostNodes) {
      doubt_all_between(from, to);
      return false;
    }
  }
  if (reached_[to] != search_) return false;

  // From above: a node that was reached leads to `to` if an arc of it does.
  std::sort(nodes_.begin(), nodes_.end(), std::greater<>());
  leads_[to] = search_;
  for (const std::uint32_t node : nodes_)
    for (std::uint32_t a = first_arc_[node]; a < first_arc_[node + 1]; ++a)
      if (graph_.hi[a].value() <= to && leads_[graph_.hi[a].value()] == search_) leads_[node] = search_;

  bool only = true;
  for (std::uint32_t node = from; node != to;) {
    std::uint32_t ways = 0, taken = 0;
    for (std::uint32_t a = first_arc_[node]; a < first_arc_[node + 1]; ++a)
      if (graph_.hi[a].value() <= to && leads_[graph_.hi[a].value()] == search_ && ways++ == 0) taken = a;
    only = only && ways == 1;
    path.push_back(ArcId(taken));
    node = graph_.hi[taken].value();
  }
  if (only) return true;
  path.clear();
  for (const std::uint32_t node : nodes_) {
    if (leads_[node] != search_) continue;
    for (std::uint32_t a = first_arc_[node]; a < first_arc_[node + 1]; ++a)
      if (graph_.hi[a].value() <= to && leads_[graph_.hi[a].value()] == search_) doubtful_[a] = true;
  }
  return false;
}

std::vector<bool> ArcPaths::doubtful() const {
  // An arc is in a span exactly if the span begins before the arc's end, and ends after the arc's start.
  std::vector<std::uint32_t> covered(spans_.size() + 1);  // by node: stretches to the next node, up to here, in spans
  std::int64_t open = 0;
  for (std::size_t n = 0; n < spans_.size(); ++n) {
    open += spans_[n];
    covered[n + 1] = covered[n] + (open > 0 ? 1 : 0);
  }
  std::vector<bool> doubtful = doubtful_;
  for (std::size_t a = 0; a < doubtful.size(); ++a)
    if (covered[graph_.lo[a].value()] != covered[graph_.hi[a].value()]) doubtful[a] = true;
  return doubtful;
}

}  // namespace reeb
