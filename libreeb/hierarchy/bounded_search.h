// Search along arcs within an interval of nodes, one arc at a time. So two searches can be advanced in turn until the
// cheaper one has the answer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// Arcs are taken in the order in which they are found (breadth first). That leaves time to prefetch an arc and its node
// before they are read.
//
// MEMORY: 4 bytes per node of the graph, kept between searches, and up to 16 bytes per arc in the queue or beyond the
//         limit.
template <class Graph = WorkingGraph>
class BoundedSearch {
 public:
  explicit BoundedSearch(const Graph& graph)
      : graph_(graph), reached_(graph.tables().template table<NodeId>(graph.end_node().value(), std::uint32_t{0})) {}

  // Begins a search at `node` that follows arcs in direction d to nodes not beyond `limit`, and forgets what was
  // reached before.
  void start(NodeId node, Direction d, NodeId limit) {
    limit_[d] = limit;
    follows_[d] = true;
    follows_[opposite(d)] = false;
    begin(node);
  }

  // The same in both directions, within the nodes from `bottom` to `top`.
  void start_both(NodeId node, NodeId bottom, NodeId top) {
    limit_[kDown] = bottom;
    limit_[kUp] = top;
    follows_[kDown] = follows_[kUp] = true;
    begin(node);
  }

  // Moves the limit farther, in the one direction that the search follows.
  void extend(NodeId limit) {
    limit_[follows_[kUp] ? kUp : kDown] = limit;
    queue_.insert(queue_.end(), beyond_.begin(), beyond_.end());
    for (const Visit& visit : beyond_) graph_.prefetch_arc(visit.arc);
    beyond_.clear();
  }

  // Takes the next arc, and continues from its far end if `enter(far end)` is true. Returns the arc, or kNone if the
  // search is over.
  template <class Enter>
  ArcId step(Enter enter) {
    while (first_ < queue_.size()) {
      prefetch_ahead();
      const auto [arc, d] = queue_[first_++];
      if (along(d, graph_.end(arc, d)) > along(d, limit_[d])) {
        beyond_.push_back({arc, d});  // arcs below it in the heap go farther still
        continue;
      }
      for (const ArcId child : graph_.below_in_heap(arc, d)) push(child, d);
      const NodeId node = graph_.end(arc, d);
      if (!reached(node) && enter(node)) reach(node);
      return arc;
    }
    return Graph::kNone;
  }
  ArcId step() {
    return step([](NodeId) { return true; });
  }
  void finish() {
    while (step() != Graph::kNone) {
    }
  }

  // To be called when the graph has renumbered its nodes. Nothing is reached then.
  void restart() {
    reached_.assign(graph_.end_node().value(), 0);
    search_ = 0;
  }

  void prefetch(NodeId node) const { graph_.tables().prefetch(reached_, node); }
  bool reached(NodeId node) const { return reached_[node] == search_; }

 private:
  struct Visit {
    ArcId arc;
    Direction direction;
  };

  void begin(NodeId node) {
    if (++search_ == 0) {
      reached_.assign(reached_.size(), 0);
      search_ = 1;
    }
    queue_.clear();
    beyond_.clear();
    first_ = 0;
    reach(node);
  }
  void reach(NodeId node) {
    reached_[node] = search_;
    for (const Direction d : {kDown, kUp})
      if (follows_[d]) push(graph_.nearest(node, d), d);
  }
  void push(ArcId arc, Direction d) {
    if (arc == Graph::kNone) return;
    graph_.prefetch_arc(arc);
    if (queue_.size() == queue_.capacity() && 2 * first_ > queue_.size()) {
      queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(first_));
      first_ = 0;
    }
    queue_.push_back({arc, d});
  }
  void prefetch_ahead() const {
    constexpr std::size_t kPrefetchDistance = 12;
    if (first_ + kPrefetchDistance >= queue_.size()) return;
    const auto [arc, d] = queue_[first_ + kPrefetchDistance];
    const NodeId node = graph_.end(arc, d);
    prefetch(node);
    graph_.prefetch_node(node);
  }

  const Graph& graph_;
  typename Graph::Tables::template Table<NodeId, std::uint32_t> reached_;  // the last search that reached each node
  std::uint32_t search_ = 0;
  std::array<NodeId, 2> limit_{};
  std::array<bool, 2> follows_{};
  std::vector<Visit> queue_;
  std::size_t first_ = 0;      // in the queue
  std::vector<Visit> beyond_;  // arcs that go beyond the limit
};

}  // namespace reeb
