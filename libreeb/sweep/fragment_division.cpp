#include "libreeb/sweep/fragment_division.h"

#include <algorithm>

#include "libreeb/sweep/chunk.h"

namespace reeb {
namespace {

// Finds how far monotone paths from each node lead, and sets Node::near_noise. NearNoise::notice() does the same for
// the live graph, where the threshold can still rise. Arcs below an arc come before it, so when an arc is passed on the
// way down, both reaches that tell whether it is near noise are final.
void find_reaches(SweepGraph& graph, double noise_below, IdVector<SweepNode, NodeReach>& reaches) {
  reaches.resize(graph.nodes.size());
  for (SweepNode n; n < graph.nodes.end_id(); ++n) {
    const double value = graph.nodes[n].key.value;
    reaches[n] = {value, {value, value}};
  }
  for (const SweepGraph::Arc& arc : graph.arcs)
    if (!arc.gone()) reaches[arc.hi].range.min = std::min(reaches[arc.hi].range.min, reaches[arc.lo].range.min);
  for (std::uint32_t a = graph.arcs.end_id().value(); a-- > 0;) {
    const SweepGraph::Arc& arc = graph.arcs[SweepArc(a)];
    if (arc.gone()) continue;
    NodeReach& lo = reaches[arc.lo];
    const NodeReach& hi = reaches[arc.hi];
    lo.range.max = std::max(lo.range.max, hi.range.max);
    if (hi.value - lo.value < noise_below &&
        (hi.value - lo.range.min < noise_below || hi.range.max - lo.value < noise_below))
      graph.nodes[arc.lo].near_noise = graph.nodes[arc.hi].near_noise = true;
  }
}

// Finds which nodes can still become (1, 1) nodes, or get further arcs. As in LiveGraph, a node that no other chunk
// uses cannot change if one of its sides has no arc, or has two arcs of which one is on no path. A node near noise can
// change while any of its arcs is on a path.
void find_changing_nodes(SweepGraph& graph) {
  using Side = SweepGraph::Side;
  auto& nodes = graph.nodes;
  const auto add = [](Side& side, bool referenced) {
    side.several = side.any;
    side.any = true;
    (referenced ? side.tied : side.loose) = true;
  };
  for (const SweepGraph::Arc& arc : graph.arcs) {
    if (arc.gone()) continue;
    add(nodes[arc.lo].up, arc.referenced);
    add(nodes[arc.hi].down, arc.referenced);
  }
  const auto lasts = [](const Side& side) { return !side.any || (side.several && side.loose); };
  for (SweepGraph::Node& node : nodes) {
    const bool stays = node.near_noise ? !node.up.tied && !node.down.tied : lasts(node.up) || lasts(node.down);
    node.can_change = node.uses != kUsedHereOnly || !(stays || node.lost_arcs);
  }
}

void add_settled_buckets(SweepGraph& graph, SweepArc arc, Fragment& fragment) {
  constexpr std::uint32_t kPrefetchDistance = 8;  // arcs
  if (const SweepArc later(arc.value() + kPrefetchDistance); later < graph.arc_buckets.end_id())
    graph.buckets.prefetch(graph.arc_buckets[later]);
  graph.buckets.drain_means(graph.arc_buckets[arc], fragment.settled_lists);
}

}  // namespace

void FragmentDivision::run(SweepGraph& graph, const SweptChunk& swept, const SweepOptions& options,
                           Fragment& fragment) {
  if (options.noise_below > 0) find_reaches(graph, options.noise_below, reaches_);
  find_changing_nodes(graph);
  divide_arcs(graph, options.bucket_exponent.has_value(), fragment);
  add_nodes(graph, swept, fragment);
  add_arcs(graph, fragment);
  if (options.bucket_exponent) add_buckets(graph, fragment);
}

// An arc is settled if it is on no path and neither of its ends can change. A node is settled if all its arcs are.
void FragmentDivision::divide_arcs(SweepGraph& graph, bool embeds, Fragment& fragment) {
  constexpr FragmentNode kOpen{0};  // numbered later
  for (SweepGraph::Node& node : graph.nodes) node.open = node.can_change ? kOpen : FragmentNode::none();

  open_arcs_.clear();
  for (SweepArc a; a < graph.arcs.end_id(); ++a) {
    const SweepGraph::Arc& arc = graph.arcs[a];
    if (arc.gone()) continue;
    SweepGraph::Node &lo = graph.nodes[arc.lo], &hi = graph.nodes[arc.hi];
    if (!arc.referenced && !lo.can_change && !hi.can_change) {
      fragment.settled_arcs.push_back({lo.key, hi.key});
      if (embeds) add_settled_buckets(graph, a, fragment);
      lo.lost_arcs = hi.lost_arcs = true;
    } else {
      open_arcs_.push_back(a);
      lo.open = hi.open = kOpen;
    }
  }
}

// Open nodes, arcs and edges are numbered in stream order, not in the order of the sweep. So what is glued together is
// near each other in memory. Those of boxes stay in the order of the sweep.
void FragmentDivision::add_nodes(SweepGraph& graph, const SweptChunk& swept, Fragment& fragment) {
  fill_with_room(node_at_, swept.order.size(), SweepNode::none());
  for (SweepNode n; n < graph.nodes.end_id(); ++n) {
    const SweepGraph::Node& node = graph.nodes[n];
    if (node.gone) continue;
    if (node.open == FragmentNode::none())
      fragment.settled_nodes.push_back({node.key, swept.position(node.vertex)});
    else
      node_at_[swept.stars != nullptr ? swept.local(node.vertex) : LocalVertex(node.vertex.value())] = n;
  }
  for (const SweepNode n : node_at_) {
    if (n == SweepNode::none()) continue;
    SweepGraph::Node& node = graph.nodes[n];
    node.open = FragmentNode(static_cast<std::uint32_t>(fragment.nodes.size()));
    fragment.nodes.push_back({node.key, node.uses, node.lost_arcs});
    if (fragment.options.noise_below > 0) {
      const double far = kNoiseAhead * fragment.options.noise_below;
      fragment.nodes.back().far_down = node.key.value - reaches_[n].range.min >= far;
      fragment.nodes.back().far_up = reaches_[n].range.max - node.key.value >= far;
    }
    if (!swept.chunk.positions.empty()) fragment.positions.push_back(swept.position(node.vertex));
  }
}

void FragmentDivision::add_arcs(SweepGraph& graph, Fragment& fragment) {
  arcs_from_.assign(fragment.nodes.size() + 1, 0);
  for (const SweepArc a : open_arcs_) ++arcs_from_[graph.nodes[graph.arcs[a].lo].open.value() + 1];
  for (std::size_t n = 1; n < arcs_from_.size(); ++n) arcs_from_[n] += arcs_from_[n - 1];
  fragment.arcs.resize(open_arcs_.size());
  for (const SweepArc a : open_arcs_) {
    SweepGraph::Arc& arc = graph.arcs[a];
    const FragmentNode lo = graph.nodes[arc.lo].open;
    arc.open = FragmentArc(arcs_from_[lo.value()]++);
    fragment.arcs[arc.open.value()] = {lo, graph.nodes[arc.hi].open};
  }
}

void FragmentDivision::add_buckets(SweepGraph& graph, Fragment& fragment) {
  arc_at_.resize(open_arcs_.size());
  for (const SweepArc a : open_arcs_) arc_at_[graph.arcs[a].open] = a;
  fragment.bucket_begin.push_back(0);
  for (const SweepArc a : arc_at_) {
    graph.buckets.drain(graph.arc_buckets[a], [&](const BucketSum& bucket) { fragment.buckets.push_back(bucket); });
    fragment.bucket_begin.push_back(static_cast<std::uint32_t>(fragment.buckets.size()));
  }
}

}  // namespace reeb
