#include "libreeb/engine/fragment_builder.h"

#include <algorithm>

namespace reeb {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

}  // namespace

void FragmentBuilder::start(std::size_t vertices, const SweepOptions& options) {
  options_ = options;
  graph_.clear();
  if (options.bucket_exponent) {
    graph_.buckets.start(*options.bucket_exponent);
    bucket_of_.assign(vertices, BucketLists::kNowhere);
  }
  shared_.clear();
  notes_.clear();
  shared_begin_.resize(vertices + 1);
  node_of_.resize(vertices);
}

std::uint32_t FragmentBuilder::add_node(std::uint32_t v) {
  node_of_[v] = static_cast<std::uint32_t>(graph_.nodes.size());
  graph_.nodes.push_back({{}, v, kNone, false, {}, {}, false, false, false, kNone});
  return node_of_[v];
}

std::uint32_t FragmentBuilder::add_arc(std::uint32_t lower_node) {
  graph_.arcs.push_back({lower_node, kNone, kNone, false});
  if (options_.bucket_exponent) graph_.arc_buckets.emplace_back();
  return static_cast<std::uint32_t>(graph_.arcs.size() - 1);
}

void FragmentBuilder::add_shared_edge(std::uint32_t lower_node, std::uint32_t hi, std::uint32_t arc,
                                      std::uint32_t place) {
  shared_.push_back({lower_node, hi, arc, place, kNone, kNone});
}

void FragmentBuilder::finish_shared_edges_of(std::uint32_t v) {
  std::sort(shared_.begin() + shared_begin_[v], shared_.end(),
            [](const Shared& a, const Shared& b) { return a.hi < b.hi; });
}

void FragmentBuilder::note_branch(std::uint32_t lo, std::uint32_t hi, std::uint32_t node, std::uint32_t arc) {
  const auto last = shared_.begin() + shared_begin_[lo + 1];
  const auto edge = std::lower_bound(shared_.begin() + shared_begin_[lo], last, hi,
                                     [](const Shared& e, std::uint32_t h) { return e.hi < h; });
  if (edge == last || edge->hi != hi) return;
  if (edge->last_note != kNone && notes_[edge->last_note].node == node) return;
  const auto note = static_cast<std::uint32_t>(notes_.size());
  notes_.push_back({node, arc, kNone});
  (edge->first_note == kNone ? edge->first_note : notes_[edge->last_note].next) = note;
  edge->last_note = note;
}

void FragmentBuilder::finish(const SweptChunk& swept, Fragment& fragment) {
  fragment.clear();
  fragment.options = options_;
  fragment.triangle_count = swept.chunk.triangle_count();
  for (SweepGraph::Node& node : graph_.nodes) node.key = swept.key(node.vertex);
  if (options_.bucket_exponent) add_positions(swept.chunk);
  if (options_.noise_below > 0) fragment.removed_pairs = leaf_removal_.run(graph_, swept, options_.noise_below);
  sort_steps(swept);
  trace_paths(fragment);
  divide(swept, fragment);
  add_steps(fragment);
}

// In the order in which they lie in memory, not in that of the sweep.
void FragmentBuilder::add_positions(const Chunk& chunk) {
  constexpr std::size_t kAhead = 16;
  const bool has_positions = !chunk.positions.empty();
  for (std::size_t i = 0; i < bucket_of_.size(); ++i) {
    if (i + kAhead < bucket_of_.size()) graph_.buckets.prefetch_sum(bucket_of_[i + kAhead]);
    graph_.buckets.add_to_bucket(bucket_of_[i], has_positions ? chunk.positions[i] : Point{});
  }
}

void FragmentBuilder::sort_steps(const SweptChunk& swept) {
  steps_.clear();
  for (std::uint32_t e = 0; e < shared_.size(); ++e) steps_.push_back(step(shared_[e].place, e, false));
  for (std::uint32_t n = 0; n < graph_.nodes.size(); ++n)
    if (swept.uses(graph_.nodes[n].vertex) == kUsedEarlier)
      steps_.push_back(step(swept.stars.last_place(graph_.nodes[n].vertex), n, true));
  std::sort(steps_.begin(), steps_.end());
}

void FragmentBuilder::trace_paths(Fragment& fragment) {
  fragment.path_begin.push_back(0);
  for (const std::uint64_t s : steps_) {
    if (completes(s)) continue;
    const Shared& edge = shared_[index(s)];
    std::uint32_t note = edge.first_note;
    for (std::uint32_t arc = edge.first_arc;;) {
      fragment.path_arcs.push_back(arc);
      graph_.arcs[arc].referenced = true;
      const std::uint32_t node = graph_.arcs[arc].hi;
      if (graph_.nodes[node].vertex == edge.hi) break;
      while (note != kNone && graph_.nodes[notes_[note].node].gone) note = notes_[note].next;
      const bool noted = note != kNone && notes_[note].node == node;
      arc = noted ? notes_[note].arc : graph_.nodes[node].main_branch;
      if (noted) note = notes_[note].next;
    }
    std::reverse(fragment.path_arcs.begin() + fragment.path_begin.back(), fragment.path_arcs.end());
    fragment.path_begin.push_back(static_cast<std::uint32_t>(fragment.path_arcs.size()));
  }
}

// Which nodes can still become (1, 1) nodes, or get further arcs. As in LiveGraph, a node that no
// other chunk uses stays one for good if on one of its sides there is no arc, or two and one of them
// without paths; a node that is near noise can change as long as there is any path.
void FragmentBuilder::find_changing_nodes(const SweptChunk& swept) {
  using Side = SweepGraph::Side;
  auto& nodes = graph_.nodes;
  auto& arcs = graph_.arcs;
  const bool noise_goes = options_.noise_below > 0;
  for (SweepGraph::Node& node : nodes) {
    node.up = node.down = {};
    node.near_noise = false;
  }
  const auto add = [](Side& side, bool referenced) {
    side.several = side.any;
    side.any = true;
    (referenced ? side.tied : side.loose) = true;
  };
  for (const SweepGraph::Arc& arc : arcs) {
    if (arc.lo == kNone) continue;
    add(nodes[arc.lo].up, arc.referenced);
    add(nodes[arc.hi].down, arc.referenced);
    if (noise_goes && graph_.length(arc) < options_.noise_below)
      nodes[arc.lo].near_noise = nodes[arc.hi].near_noise = true;
  }
  const auto lasts = [](const Side& side) { return !side.any || (side.several && side.loose); };
  for (SweepGraph::Node& node : nodes) {
    const bool stays = node.near_noise ? !node.up.tied && !node.down.tied : lasts(node.up) || lasts(node.down);
    node.can_change = swept.uses(node.vertex) != kUsedHereOnly || !stays;
  }
}

// Divides nodes and arcs into open and settled ones (DESIGN.md 2): an arc is settled if no path
// runs on it and none of its ends can change; a node leaves when all its arcs do.
void FragmentBuilder::divide(const SweptChunk& swept, Fragment& fragment) {
  find_changing_nodes(swept);
  auto& nodes = graph_.nodes;
  auto& arcs = graph_.arcs;
  for (SweepGraph::Node& node : nodes) node.open = node.can_change ? 0 : kNone;

  open_arcs_.clear();
  for (std::uint32_t a = 0; a < arcs.size(); ++a) {
    if (arcs[a].lo == kNone) continue;
    SweepGraph::Node &lo = nodes[arcs[a].lo], &hi = nodes[arcs[a].hi];
    if (!arcs[a].referenced && !lo.can_change && !hi.can_change) {
      add_settled_arc(a, fragment);
      lo.lost_arcs = hi.lost_arcs = true;
    } else {
      open_arcs_.push_back(a);
      lo.open = hi.open = 0;
    }
  }
  add_nodes(swept, fragment);
  add_arcs(fragment);
}

void FragmentBuilder::add_settled_arc(std::uint32_t arc, Fragment& fragment) {
  fragment.settled_arcs.push_back({graph_.nodes[graph_.arcs[arc].lo].key, graph_.nodes[graph_.arcs[arc].hi].key});
  if (!options_.bucket_exponent) return;
  constexpr std::size_t kAhead = 8;
  if (arc + kAhead < graph_.arc_buckets.size()) graph_.buckets.prefetch(graph_.arc_buckets[arc + kAhead]);
  const std::size_t before = fragment.settled_buckets.size();
  graph_.buckets.drain(graph_.arc_buckets[arc],
                       [&](const BucketSum& bucket) { fragment.settled_buckets.push_back(bucket.mean()); });
  fragment.settled_bucket_counts.push_back(static_cast<std::uint32_t>(fragment.settled_buckets.size() - before));
}

// Open nodes, and arcs and edges too, are numbered in the order of the stream, not of the sweep:
// what is glued together then lies together in memory.
void FragmentBuilder::add_nodes(const SweptChunk& swept, Fragment& fragment) {
  node_at_.assign(swept.order.size(), kNone);
  for (std::uint32_t n = 0; n < graph_.nodes.size(); ++n) {
    const std::uint32_t v = graph_.nodes[n].vertex;
    if (graph_.nodes[n].gone) continue;
    if (graph_.nodes[n].open == kNone)
      fragment.settled_nodes.push_back({graph_.nodes[n].key, swept.position(v)});
    else
      node_at_[swept.order[v]] = n;
  }
  for (const std::uint32_t n : node_at_) {
    if (n == kNone) continue;
    SweepGraph::Node& node = graph_.nodes[n];
    node.open = static_cast<std::uint32_t>(fragment.nodes.size());
    fragment.nodes.push_back({node.key, swept.uses(node.vertex), node.lost_arcs});
    if (!swept.chunk.positions.empty()) fragment.positions.push_back(swept.position(node.vertex));
  }
}

void FragmentBuilder::add_arcs(Fragment& fragment) {
  arcs_from_.assign(fragment.nodes.size() + 1, 0);
  for (const std::uint32_t a : open_arcs_) ++arcs_from_[graph_.nodes[graph_.arcs[a].lo].open + 1];
  for (std::size_t n = 1; n < arcs_from_.size(); ++n) arcs_from_[n] += arcs_from_[n - 1];
  fragment.arcs.resize(open_arcs_.size());
  for (const std::uint32_t a : open_arcs_) {
    const std::uint32_t lo = graph_.nodes[graph_.arcs[a].lo].open;
    graph_.arcs[a].open = arcs_from_[lo]++;
    fragment.arcs[graph_.arcs[a].open] = {lo, graph_.nodes[graph_.arcs[a].hi].open};
  }
  for (std::uint32_t& arc : fragment.path_arcs) arc = graph_.arcs[arc].open;
  if (options_.bucket_exponent) add_buckets(fragment);
}

void FragmentBuilder::add_buckets(Fragment& fragment) {
  arc_at_.resize(open_arcs_.size());
  for (const std::uint32_t a : open_arcs_) arc_at_[graph_.arcs[a].open] = a;
  fragment.bucket_begin.push_back(0);
  for (const std::uint32_t a : arc_at_) {
    graph_.buckets.drain(graph_.arc_buckets[a], [&](const BucketSum& bucket) { fragment.buckets.push_back(bucket); });
    fragment.bucket_begin.push_back(static_cast<std::uint32_t>(fragment.buckets.size()));
  }
}

void FragmentBuilder::add_steps(Fragment& fragment) {
  for (const std::uint64_t s : steps_) {
    if (completes(s)) {
      fragment.steps.push_back({place(s), graph_.nodes[index(s)].open, true});
    } else {
      const Shared& edge = shared_[index(s)];
      fragment.steps.push_back({place(s), static_cast<std::uint32_t>(fragment.edges.size()), false});
      fragment.edges.push_back({graph_.nodes[edge.lo].open, graph_.nodes[node_of_[edge.hi]].open});
    }
  }
}

std::size_t FragmentBuilder::memory_bytes() const {
  return graph_.memory_bytes() + leaf_removal_.memory_bytes() + shared_.capacity() * sizeof(Shared) +
         notes_.capacity() * sizeof(Note) + 8 * steps_.capacity() +
         4 * (shared_begin_.capacity() + node_of_.capacity() + node_at_.capacity() + open_arcs_.capacity() +
              arcs_from_.capacity() + arc_at_.capacity() + bucket_of_.capacity());
}

}  // namespace reeb
