#include "libreeb/engine/glue.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb {
namespace {

constexpr std::size_t kLookAhead = 8;  // entries of hash maps

// Of a copy: those that an arc with its beads becomes.
struct FragmentArcs {
  std::uint32_t first, end;
};

}  // namespace

void Glue::add(const Fragment& fragment, const std::function<void(std::size_t)>& grown) {
  graph_.set_options(fragment.options);
  removed_in_fragments_ += fragment.removed_pairs;
  fragment.pass_settled_to(*sink_);
  add_nodes(fragment);
  add_arcs(fragment);
  if (log_ != nullptr) place_regular(fragment);
  add_paths(fragment);
  add_closed_edges(fragment);
  for (const Index a : arcs_) graph_.release(a);
  run_steps(fragment, grown);
  graph_.tidy();
  graph_.flush();
}

void Glue::add_nodes(const Fragment& fragment) {
  nodes_.clear();
  for (std::size_t i = 0; i < fragment.nodes.size(); ++i) {
    const Fragment::Node& node = fragment.nodes[i];
    if (i + kLookAhead < fragment.nodes.size()) node_of_.prefetch(fragment.nodes[i + kLookAhead].key.vertex.value());
    const std::uint64_t vertex = node.key.vertex.value();
    Index n = (node.uses & kUsedEarlier) != 0 ? node_of_.find(vertex) : kNone;
    if (n != kNone && graph_.key(n).value != node.key.value) throw input_changed();
    if (n == kNone) {
      const auto state = node.settled                 ? LiveGraph::State::kSettled
                         : node.uses == kUsedHereOnly ? LiveGraph::State::kComplete
                                                      : LiveGraph::State::kIncomplete;
      n = graph_.add_node(node.key, fragment.positions.empty() ? Point{} : fragment.positions[i], state);
      grow_first_link(n + 1);
      first_link_[n] = kNone;
      if ((node.uses & kUsedLater) != 0) node_of_.find_or_insert(vertex, n);
    }
    graph_.set_far(n, node.far_down, node.far_up);
    nodes_.push_back(n);
  }
}

void Glue::grow_first_link(std::size_t nodes) {
  const std::size_t before = first_link_.size();
  if (nodes <= before) return;
  first_link_.grow_by(nodes - before);
  for (std::size_t n = before; n < nodes; ++n) first_link_[n] = kNone;
}

void Glue::add_arcs(const Fragment& fragment) {
  arcs_.clear();
  for (const Fragment::Arc& arc : fragment.arcs) arcs_.push_back(graph_.add_arc(node(arc.lo), node(arc.hi)));
  for (std::size_t i = 0; i + 1 < fragment.bucket_begin.size(); ++i)
    graph_.add_buckets(arcs_[i],
                       std::span(fragment.buckets)
                           .subspan(fragment.bucket_begin[i], fragment.bucket_begin[i + 1] - fragment.bucket_begin[i]));
}

void Glue::place_regular(const Fragment& fragment) {
  const std::uint32_t first = log_->settle_unnamed(static_cast<std::uint32_t>(fragment.settled_arcs.size()));
  for (const auto& [vertex, arc] : fragment.on_settled_arcs) log_->place_on_settled(first + arc, vertex);
  for (const auto& [vertex, arc] : fragment.on_open_arcs) log_->place(arcs_[arc], vertex);
}

// All paths are added before the first zip, since zips change the arcs that later paths of the fragment run on.
void Glue::add_paths(const Fragment& fragment) {
  pending_.assign(fragment.edges.size(), {});
  for (std::size_t i = 0; i < fragment.edges.size(); ++i) {
    if (i + kLookAhead < fragment.edges.size()) {
      const auto [lo, hi] = fragment.edges[i + kLookAhead];
      edge_of_.prefetch(edge_key(node(lo), node(hi)));
    }
    const auto [lo, hi] = fragment.edges[i];
    const Index known = edge_of_.find(edge_key(node(lo), node(hi)));
    const bool needed_later = (fragment.nodes[lo.value()].uses & fragment.nodes[hi.value()].uses & kUsedLater) != 0;
    if (known != kNone && edges_[known].top == kNone) throw third_triangle(node(lo), node(hi));
    if (known != kNone)
      pending_[i] = {known, add_path(fragment, i)};
    else if (needed_later)
      add_edge(node(lo), node(hi), add_path(fragment, i));
  }
}

// Closed edges stay known as long as another triangle can come, so none goes unnoticed.
void Glue::add_closed_edges(const Fragment& fragment) {
  for (const auto& [lo, hi] : fragment.closed_edges) {
    if (edge_of_.find(edge_key(node(lo), node(hi))) != kNone) throw third_triangle(node(lo), node(hi));
    if ((fragment.nodes[lo.value()].uses & fragment.nodes[hi.value()].uses & kUsedLater) != 0)
      add_edge(node(lo), node(hi), kNone);
  }
}

Error Glue::third_triangle(Index lo, Index hi) const {
  return not_manifold(graph_.key(lo).vertex.value(), graph_.key(hi).vertex.value());
}

LiveGraph::Index Glue::add_path(const Fragment& fragment, std::size_t edge) {
  Index top = kNone;
  for (std::size_t i = fragment.path_begin[edge + 1]; i-- > fragment.path_begin[edge];)
    top = graph_.add_reference(arcs_[fragment.path_arcs[i].value()], top);
  return top;
}

// Vertices are completed between zips, in stream order. That keeps short the paths that are still to be zipped.
void Glue::run_steps(const Fragment& fragment, const std::function<void(std::size_t)>& grown) {
  constexpr std::size_t kStepsAtOnce = 64;
  for (std::size_t i = 0; i < fragment.steps.size(); ++i) {
    if (i % kStepsAtOnce == 0) {
      prefetch(std::span(fragment.steps).subspan(i, std::min(kStepsAtOnce, fragment.steps.size() - i)));
      if (grown) grown(memory_bytes());
    }
    const Fragment::Step& step = fragment.steps[i];
    if (step.completes) {
      complete_node(nodes_[step.index]);
    } else if (const auto [edge, top] = pending_[step.index]; edge != kNone) {
      graph_.zip(edges_[edge].top, top);
      const auto [lo, hi] = fragment.edges[step.index];
      if ((fragment.nodes[lo.value()].uses & fragment.nodes[hi.value()].uses & kUsedLater) == 0)
        drop_edge(edge);
      else if (fragment.options.manifold)
        graph_.drop_path(std::exchange(edges_[edge].top, kNone));
      graph_.tidy();
    }
  }
}

// Each arc of a path is somewhere else in memory, and a zip follows the path from one to the next. So the paths of many
// steps are followed at the same time before, up to the length that most of them have.
void Glue::prefetch(std::span<const Fragment::Step> steps) {
  constexpr int kLength = 24;
  ahead_.clear();
  for (const Fragment::Step& step : steps) {
    if (step.completes) {
      node_of_.prefetch(graph_.key(nodes_[step.index]).vertex.value());
      graph_.prefetch_position(nodes_[step.index]);
    } else if (const Index edge = pending_[step.index].edge; edge != kNone) {
      ahead_.push_back(edges_[edge].top);
      edge_of_.prefetch(edge_key(edges_[edge].lo, edges_[edge].hi));
    }
  }
  for (int i = 0; i < kLength && !ahead_.empty(); ++i) {
    std::size_t left = 0;
    for (const Index top : ahead_)
      if (const Index below = graph_.prefetch(top); below != kNone) ahead_[left++] = below;
    ahead_.resize(left);
  }
}

void Glue::complete_node(Index n) {
  while (first_link_[n] != kNone) drop_edge(first_link_[n] / 2);
  node_of_.erase(graph_.key(n).vertex.value());
  graph_.complete(n);
  graph_.tidy();
}

// ---- for other fragments than those of the stream

void Glue::complete(VertexId vertex) {
  const Index n = node_of_.find(vertex.value());
  if (n == kNone) return;
  complete_node(n);
  graph_.flush();
}

void Glue::copy_live(Fragment& fragment) const {
  using State = LiveGraph::State;
  const std::size_t path_arcs = graph_.path_arc_count();
  if (path_arcs > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::kResource, "the edges at the border have paths of more than 2^32 arcs together",
                "divide the mesh into more parts, or remove noise with --denoise");
  fragment.clear();
  std::vector<FragmentNode> node_numbers(graph_.node_slots());
  std::vector<FragmentArcs> arcs_of(graph_.arc_slots());
  fragment.nodes.reserve(graph_.node_count());
  fragment.positions.reserve(graph_.node_count());
  fragment.arcs.reserve(graph_.arc_count());
  fragment.bucket_begin.reserve(graph_.arc_count() + 1);
  fragment.buckets.reserve(graph_.bucket_count());
  fragment.edges.reserve(edge_of_.size());
  fragment.path_begin.reserve(edge_of_.size() + 1);
  fragment.path_arcs.reserve(path_arcs);
  fragment.bucket_begin.push_back(0);
  const auto add_node = [&](const Fragment::Node& node, const Point& position) {
    fragment.nodes.push_back(node);
    fragment.positions.push_back(position);
    return FragmentNode(static_cast<std::uint32_t>(fragment.nodes.size() - 1));
  };
  const auto add_arc = [&](FragmentNode lo, FragmentNode hi) {
    fragment.arcs.push_back({lo, hi});
    fragment.bucket_begin.push_back(static_cast<std::uint32_t>(fragment.buckets.size()));
  };
  graph_.visit(
      [&](Index n) {
        const auto uses = graph_.state(n) == State::kIncomplete ? kUsedLater : kUsedHereOnly;
        node_numbers[n] = add_node({graph_.key(n), uses, graph_.state(n) == State::kSettled}, graph_.position(n));
      },
      [&](Index a, Index lo, Index hi) {
        arcs_of[a].first = static_cast<std::uint32_t>(fragment.arcs.size());
        FragmentNode above = node_numbers[hi];
        graph_.visit_chain(
            a,
            [&](const SweepKey& key, const Point& position) {
              const FragmentNode bead = add_node({key, kUsedHereOnly, true}, position);
              add_arc(bead, std::exchange(above, bead));
            },
            [&](const BucketSum& bucket) { fragment.buckets.push_back(bucket); });
        add_arc(node_numbers[lo], above);
        arcs_of[a].end = static_cast<std::uint32_t>(fragment.arcs.size());
      });
  fragment.path_begin.push_back(0);
  for (Index n = 0; n < first_link_.size(); ++n) {
    if (!graph_.is_incomplete(n)) continue;
    for (Index l = first_link_[n]; l != kNone; l = links_[l].next) {
      if (l % 2 != 0) continue;  // the upper end's link of the same edge
      const Edge& edge = edges_[l / 2];
      fragment.edges.push_back({node_numbers[edge.lo], node_numbers[edge.hi]});
      graph_.visit_path(edge.top, [&](Index a) {
        for (std::uint32_t i = arcs_of[a].first; i < arcs_of[a].end; ++i) fragment.path_arcs.push_back(FragmentArc(i));
      });
      fragment.path_begin.push_back(static_cast<std::uint32_t>(fragment.path_arcs.size()));
    }
  }
}

std::size_t Glue::copy_bytes() const {
  return graph_.node_count() * (sizeof(Fragment::Node) + sizeof(Point)) +
         graph_.arc_count() * (sizeof(Fragment::Arc) + 4) + graph_.bucket_count() * sizeof(BucketSum) +
         edge_of_.size() * (sizeof(Fragment::SharedEdge) + 4) + 4 * graph_.path_arc_count() +
         graph_.node_slots() * sizeof(FragmentNode) + graph_.arc_slots() * sizeof(FragmentArcs) +
         2 * 4;  // path_begin and bucket_begin have an entry more than edges and arcs
}

// ---- kept edges

void Glue::add_edge(Index lo, Index hi, Index top) {
  Index e = first_free_edge_;
  if (e != kNone) {
    first_free_edge_ = edges_[e].top;
  } else {
    e = static_cast<Index>(edges_.size());
    edges_.grow_by(1);
    links_.grow_by(2);
  }
  edges_[e] = {lo, hi, top};
  link(2 * e, lo);
  link(2 * e + 1, hi);
  edge_of_.find_or_insert(edge_key(lo, hi), e);
}

void Glue::drop_edge(Index e) {
  const Edge edge = edges_[e];
  unlink(2 * e, edge.lo);
  unlink(2 * e + 1, edge.hi);
  edge_of_.erase(edge_key(edge.lo, edge.hi));
  edges_[e].top = std::exchange(first_free_edge_, e);
  graph_.drop_path(edge.top);
}

void Glue::link(Index l, Index n) {
  links_[l] = {first_link_[n], kNone};
  if (first_link_[n] != kNone) links_[first_link_[n]].prev = l;
  first_link_[n] = l;
}

void Glue::unlink(Index l, Index n) {
  const auto [next, prev] = links_[l];
  (prev == kNone ? first_link_[n] : links_[prev].next) = next;
  if (next != kNone) links_[next].prev = prev;
}

std::size_t Glue::memory_bytes() const {
  return graph_.memory_bytes() + node_of_.memory_bytes() + edge_of_.memory_bytes() + edges_.memory_bytes() +
         links_.memory_bytes() + first_link_.memory_bytes() + (nodes_.capacity() + arcs_.capacity()) * sizeof(Index) +
         pending_.capacity() * sizeof(Pending);
}

std::size_t Glue::memory_bytes_with(const Fragment& fragment) const {
  return memory_bytes() +
         graph_.growth_bytes(fragment.nodes.size(), fragment.arcs.size(), fragment.path_arcs.size(),
                             fragment.buckets.size()) +
         node_of_.growth_bytes(fragment.nodes.size()) + edge_of_.growth_bytes(fragment.edges.size());
}

// ---- saving and restoring, between two fragments; the two maps are rebuilt from the arrays

void Glue::save(StateWriter& out) const {
  graph_.save(out);
  out.put(removed_in_fragments_);
  first_link_.save(out);
  edges_.save(out);
  links_.save(out);
  out.put(first_free_edge_);
}

void Glue::restore(StateReader& in) {
  LiveGraph::PathTops tops = graph_.restore(in);
  in.get(removed_in_fragments_);
  first_link_.restore(in);
  edges_.restore(in);
  links_.restore(in);
  in.get(first_free_edge_);
  restore_nodes();
  restore_edges(std::move(tops));
}

void Glue::restore_nodes() {
  node_of_.clear();
  require_state(first_link_.size() <= graph_.node_slots());
  grow_first_link(graph_.node_slots());
  for (Index n = 0; n < first_link_.size(); ++n)
    if (graph_.is_incomplete(n) && node_of_.find_or_insert(graph_.key(n).vertex.value(), n) != n) throw DamagedState();
}

// Every link is in one list, and every path belongs to one edge between incomplete nodes.
void Glue::restore_edges(LiveGraph::PathTops tops) {
  edge_of_.clear();
  require_state(links_.size() == 2 * edges_.size());
  std::vector<bool> is_free(edges_.size());
  for (Index e = first_free_edge_; e != kNone; e = edges_[e].top) {
    require_state(e < edges_.size() && !is_free[e]);
    is_free[e] = true;
  }
  std::size_t links = 0;
  for (Index n = 0; n < first_link_.size(); ++n) {
    if (!graph_.is_incomplete(n)) continue;
    for (Index l = first_link_[n], before = kNone; l != kNone; before = l, l = links_[l].next, ++links) {
      require_state(l < links_.size() && !is_free[l / 2] && links_[l].prev == before && links < links_.size());
      require_state((l % 2 == 0 ? edges_[l / 2].lo : edges_[l / 2].hi) == n);
    }
  }
  for (Index e = 0; e < edges_.size(); ++e) {
    if (is_free[e]) continue;
    const Edge& edge = edges_[e];
    require_state(edge_of_.find_or_insert(edge_key(edge.lo, edge.hi), e) == e);
    if (edge.top == kNone) continue;
    require_state(edge.top < tops.size() && tops[edge.top] && graph_.has_ends(edge.top, edge.lo, edge.hi));
    tops[edge.top] = false;
  }
  require_state(links == 2 * edge_of_.size());
  require_state(std::find(tops.begin(), tops.end(), true) == tops.end());
}

}  // namespace reeb
