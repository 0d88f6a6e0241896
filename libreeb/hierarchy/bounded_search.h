// Search along arcs within an interval of nodes, one arc at a time.
//
// Two searches can so be advanced in turn until the cheaper one has the answer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// MEMORY: 4 bytes a node of the graph, kept between searches, and 8 bytes an arc on the stack.
class BoundedSearch {
 public:
  explicit BoundedSearch(const WorkingGraph& graph) : graph_(graph), reached_(graph.node_count()) {}

  // Begins a search at `node` that follows arcs in direction d to nodes not beyond `limit`, and
  // forgets what was reached before.
  void start(std::uint32_t node, Direction d, std::uint32_t limit) {
    limit_[d] = limit;
    follows_[d] = true;
    follows_[opposite(d)] = false;
    begin(node);
  }

  // The same in both directions, to nodes from `bottom` to `top`.
  void start_both(std::uint32_t node, std::uint32_t bottom, std::uint32_t top) {
    limit_[kDown] = bottom;
    limit_[kUp] = top;
    follows_[kDown] = follows_[kUp] = true;
    begin(node);
  }

  // Follows one arc to its far end if `enter(far end)`. Returns the arc, kNone when none is left.
  template <class Enter>
  std::uint32_t step(Enter enter) {
    if (stack_.empty()) return WorkingGraph::kNone;
    const auto [arc, d] = stack_.back();
    stack_.pop_back();
    for (const std::uint32_t child : graph_.below_in_heap(arc, d)) push(child, d);
    const std::uint32_t node = graph_.end(arc, d);
    if (!reached(node) && enter(node)) reach(node);
    return arc;
  }
  std::uint32_t step() {
    return step([](std::uint32_t) { return true; });
  }
  void finish() {
    while (step() != WorkingGraph::kNone) {
    }
  }

  void prefetch(std::uint32_t node) const { __builtin_prefetch(&reached_[node]); }
  bool reached(std::uint32_t node) const { return reached_[node] == search_; }

 private:
  struct Visit {
    std::uint32_t arc;
    Direction direction;
  };

  void begin(std::uint32_t node) {
    if (++search_ == 0) {
      reached_.assign(reached_.size(), 0);
      search_ = 1;
    }
    stack_.clear();
    reach(node);
  }
  void reach(std::uint32_t node) {
    reached_[node] = search_;
    for (const Direction d : {kDown, kUp})
      if (follows_[d]) push(graph_.nearest(node, d), d);
  }
  void push(std::uint32_t arc, Direction d) {
    if (arc != WorkingGraph::kNone && along(d, graph_.end(arc, d)) <= along(d, limit_[d]))
      stack_.push_back({arc, d});
  }

  const WorkingGraph& graph_;
  std::vector<std::uint32_t> reached_;  // the last search that reached each node
  std::uint32_t search_ = 0;
  std::array<std::uint32_t, 2> limit_{};
  std::array<bool, 2> follows_{};
  std::vector<Visit> stack_;
};

}  // namespace reeb
