#include "libreeb/sweep/fragment_builder.h"

#include <algorithm>
#include <cstddef>

#include "libreeb/sweep/chunk.h"

namespace reeb {

void FragmentBuilder::start(std::size_t vertices, const SweepOptions& options) {
  options_ = options;
  graph_.clear();
  if (options.bucket_exponent) graph_.buckets.start(*options.bucket_exponent);
  if (options.notes_regular()) fill_with_room(arc_of_regular_, vertices, SweepArc::none());
  node_of_.resize(vertices);
}

SweepNode FragmentBuilder::add_node(VertexRank v) { return node_of_[v] = graph_.nodes.add({.vertex = v}); }

SweepArc FragmentBuilder::add_arc(SweepNode lower_node) {
  if (options_.bucket_exponent) graph_.arc_buckets.add({});
  return graph_.arcs.add({lower_node, SweepNode::none(), FragmentArc::none(), false});
}

void FragmentBuilder::end_sweep(const SweptChunk& swept) {
  for (SweepGraph::Node& node : graph_.nodes) {
    node.key = swept.key(node.vertex);
    node.uses = swept.uses(node.vertex);
  }
  if (options_.bucket_exponent) embedding_.run(graph_, swept, arc_of_regular_, *options_.bucket_exponent);
}

void FragmentBuilder::start_fragment(const SweptChunk& swept, Fragment& fragment) {
  fragment.clear();
  fragment.options = options_;
  fragment.triangle_count = swept.chunk.triangle_count();
  fragment.shared_faces = swept.chunk.shared_faces;
  if (options_.noise_below > 0) fragment.removed_pairs = leaf_removal_.run(graph_, swept, options_.noise_below);
}

void FragmentBuilder::finish(const SweptChunk& swept, const SharedEdges& shared, Fragment& fragment) {
  start_fragment(swept, fragment);
  sort_steps(swept, shared);
  trace_paths(shared, fragment);
  division_.run(graph_, swept, options_, fragment);
  fragment.path_arcs.reserve(path_arcs_.size());
  for (const SweepArc arc : path_arcs_) fragment.path_arcs.push_back(graph_.arcs[arc].open);
  for (const auto& [lo, hi] : shared.closed())
    fragment.closed_edges.push_back({graph_.nodes[lo].open, graph_.nodes[node_of_[hi]].open});
  add_steps(shared, fragment);
  if (options_.follows_vertices) add_followed(swept, fragment);
}

// Settled arcs are in the fragment in the order of the sweep.
void FragmentBuilder::add_followed(const SweptChunk& swept, Fragment& fragment) {
  settled_number_.clear();
  std::uint32_t settled = 0;
  for (const SweepGraph::Arc& arc : graph_.arcs)
    settled_number_.push_back(arc.open == FragmentArc::none() ? settled++ : 0);
  for (VertexRank v; v.value() < swept.order.size(); ++v) {
    const SweepArc arc = arc_of_regular_[swept.local(v)];
    if (arc == SweepArc::none()) continue;
    const SweepKey vertex = swept.key(v);
    if (const FragmentArc open = graph_.arcs[arc].open; open != FragmentArc::none())
      fragment.on_open_arcs.push_back({vertex, open.value()});
    else
      fragment.on_settled_arcs.push_back({vertex, settled_number_[arc.value()]});
  }
}

void FragmentBuilder::finish_tree(const SweptChunk& swept, Fragment& fragment) {
  start_fragment(swept, fragment);
  mark_arcs_between_used();
  division_.run(graph_, swept, options_, fragment);
}

// Takes leaves away that no other chunk uses, until there are none.
void FragmentBuilder::mark_arcs_between_used() {
  degrees_.assign(graph_.nodes.size(), 0);
  arcs_xor_.assign(graph_.nodes.size(), 0);
  const auto toggle = [&](SweepNode n, SweepArc arc, int change) {
    degrees_[n.value()] += static_cast<std::uint32_t>(change);
    arcs_xor_[n.value()] ^= arc.value();
  };
  for (SweepArc a; a < graph_.arcs.end_id(); ++a) {
    SweepGraph::Arc& arc = graph_.arcs[a];
    if (arc.gone()) continue;
    arc.referenced = true;
    toggle(arc.lo, a, 1);
    toggle(arc.hi, a, 1);
  }
  const auto is_unused_leaf = [&](SweepNode n) {
    return degrees_[n.value()] == 1 && graph_.nodes[n].uses == kUsedHereOnly;
  };
  leaves_.clear();
  for (SweepNode n; n < graph_.nodes.end_id(); ++n)
    if (is_unused_leaf(n)) leaves_.push_back(n);
  while (!leaves_.empty()) {
    const SweepNode leaf = leaves_.back();
    leaves_.pop_back();
    if (degrees_[leaf.value()] == 0) continue;  // the other end of the last arc
    const SweepArc a(arcs_xor_[leaf.value()]);
    SweepGraph::Arc& arc = graph_.arcs[a];
    arc.referenced = false;
    const SweepNode other = arc.lo == leaf ? arc.hi : arc.lo;
    toggle(leaf, a, -1);
    toggle(other, a, -1);
    if (is_unused_leaf(other)) leaves_.push_back(other);
  }
}

void FragmentBuilder::sort_steps(const SweptChunk& swept, const SharedEdges& shared) {
  steps_.clear();
  for (std::uint32_t e = 0; e < shared.size(); ++e) steps_.emplace_back(shared[e].place, e, false);
  for (SweepNode n; n < graph_.nodes.end_id(); ++n) {
    const SweepGraph::Node& node = graph_.nodes[n];
    if (node.uses == kUsedEarlier) steps_.emplace_back(swept.last_place(node.vertex), n.value(), true);
  }
  std::sort(steps_.begin(), steps_.end());
}

void FragmentBuilder::trace_paths(const SharedEdges& shared, Fragment& fragment) {
  path_arcs_.clear();
  fragment.path_begin.push_back(0);
  for (const PackedStep step : steps_) {
    if (step.completes()) continue;
    shared.trace(shared[step.index()], graph_, [&](SweepArc arc) {
      path_arcs_.push_back(arc);
      graph_.arcs[arc].referenced = true;
    });
    std::reverse(path_arcs_.begin() + fragment.path_begin.back(), path_arcs_.end());
    fragment.path_begin.push_back(static_cast<std::uint32_t>(path_arcs_.size()));
  }
}

void FragmentBuilder::add_steps(const SharedEdges& shared, Fragment& fragment) const {
  for (const PackedStep step : steps_) {
    if (step.completes()) {
      const FragmentNode node = graph_.nodes[SweepNode(step.index())].open;
      fragment.steps.push_back({step.place(), node.value(), true});
    } else {
      const SharedEdges::Edge& edge = shared[step.index()];
      fragment.steps.push_back({step.place(), static_cast<std::uint32_t>(fragment.edges.size()), false});
      fragment.edges.push_back({graph_.nodes[edge.lo].open, graph_.nodes[node_of_[edge.hi]].open});
    }
  }
}

std::size_t FragmentBuilder::memory_bytes() const {
  return graph_.memory_bytes() + embedding_.memory_bytes() + leaf_removal_.memory_bytes() + division_.memory_bytes() +
         8 * steps_.capacity() +
         4 * (node_of_.capacity() + arc_of_regular_.capacity() + settled_number_.capacity() + path_arcs_.capacity() +
              degrees_.capacity() + arcs_xor_.capacity() + leaves_.capacity());
}

}  // namespace reeb
