// Follows paths that take the nearest arc at each node, a section of many nodes at a time.
//
// WHY. A path next to a long arc has the nodes of all branches that were ever moved there. Only a few per cent of the
// paths that cancelling follows are of this kind, but they make up nearly all of its steps, always along the same
// nodes.
//
// So nodes that were followed one by one become a section: consecutive nodes of a path from each of which it leads to
// the same exit. A section stays valid when nodes are removed from its path, and includes a few nodes that are inserted
// there. Other changes break it, and its nodes are followed one by one the next time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// MEMORY: 8.5 bytes per node of the graph.
template <class Graph = WorkingGraph>
class PathFollower {
 public:
  explicit PathFollower(const Graph& graph)
      : graph_(graph),
        section_of_(
            graph.tables().template table<NodeId>(graph.end_node().value(), std::array{kNoSection, kNoSection})),
        exits_{kNone} {}

  // To be called when the nearest arc of a node in direction d has changed, or its end has. Other changes may follow;
  // follow() and apply_changes() then use the final state.
  void note(NodeId node, Direction d) {
    if (exit_of(node, d) != kNone) changed_.push_back({node, d});
  }
  // Takes the noted changes into account, and forgets them. To be called from time to time, since they take memory
  // until then.
  void apply_changes();
  // To be called when the graph has renumbered its nodes. Forgets all sections and changes.
  void restart() {
    section_of_.assign(graph_.end_node().value(), {kNoSection, kNoSection});
    exits_.resize(1);
    changed_.clear();
  }

  void prefetch(NodeId node) const { graph_.tables().prefetch(section_of_, node); }

  // The last node of the path from `node` in direction d for which `passes` is true, or `node` itself.
  // REQUIRES: the node has arcs; on the path, `passes` is false for all nodes after the first for which it is false.
  template <class Passes>
  NodeId follow(NodeId node, Direction d, Passes passes);

 private:
  static constexpr NodeId kNone = NodeId::none();
  static constexpr std::uint32_t kNoSection = 0;
  static constexpr std::size_t kMinNodes = 8, kMaxNodes = 16;  // of a section when it is made
  static constexpr std::size_t kMaxInserted = 4;

  struct Change {
    NodeId node;
    Direction direction;
  };

  NodeId exit_of(NodeId node, Direction d) const { return exits_[section_of_[node][d]]; }
  void keep_followed(NodeId exit, Direction d);
  bool still_leads_to_exit(NodeId node, Direction d);

  const Graph& graph_;
  typename Graph::Tables::template Table<NodeId, std::array<std::uint32_t, 2>> section_of_;  // by direction
  std::vector<NodeId> exits_;     // by section; kNone if it broke
  std::vector<Change> changed_;   // nodes of sections, not yet taken into account
  std::vector<NodeId> followed_;  // nodes that were followed one by one, in no section
};

template <class Graph>
template <class Passes>
NodeId PathFollower<Graph>::follow(NodeId node, Direction d, Passes passes) {
  apply_changes();
  followed_.clear();
  while (true) {
    const NodeId exit = exit_of(node, d);
    if (exit == kNone) {
      if (followed_.size() == kMaxNodes) keep_followed(node, d);
      followed_.push_back(node);
    } else {
      keep_followed(node, d);
      if (!passes(exit)) break;
      node = exit;
      continue;
    }
    const NodeId to = graph_.next(node, d);
    if (to == kNone || !passes(to)) {
      keep_followed(node, d);
      return node;
    }
    node = to;
  }
  // The last node is before this exit, so sections are of no more use.
  for (NodeId to = graph_.next(node, d); to != kNone && passes(to); to = graph_.next(to, d)) node = to;
  return node;
}

// Makes a section of the nodes that were followed before `exit`, if there are enough of them.
template <class Graph>
void PathFollower<Graph>::keep_followed(NodeId exit, Direction d) {
  if (!followed_.empty() && followed_.back() == exit) followed_.pop_back();
  if (followed_.size() >= kMinNodes) {
    if (exits_.size() > graph_.end_node().value() / kMinNodes) {
      section_of_.assign(section_of_.size(), {kNoSection, kNoSection});
      exits_.resize(1);
    }
    for (const NodeId node : followed_) section_of_[node][d] = static_cast<std::uint32_t>(exits_.size());
    exits_.push_back(exit);
  }
  followed_.clear();
}

template <class Graph>
void PathFollower<Graph>::apply_changes() {
  for (const auto [node, d] : changed_) {
    NodeId& exit = exits_[std::as_const(section_of_)[node][d]];
    if (exit != kNone && !still_leads_to_exit(node, d)) exit = kNone;
  }
  changed_.clear();
}

// Whether the path from a node of a section still leads to another node of the section, or to its exit. Nodes that were
// inserted on the way become part of the section. A node that was removed leaves it.
template <class Graph>
bool PathFollower<Graph>::still_leads_to_exit(NodeId node, Direction d) {
  const std::uint32_t section = std::as_const(section_of_)[node][d];
  const auto is_in = [&](NodeId other) {
    return other == exits_[section] || std::as_const(section_of_)[other][d] == section;
  };
  std::array<NodeId, kMaxInserted> inserted{};
  std::size_t count = 0;
  NodeId to = graph_.next(node, d);
  if (to == kNone) {
    if (graph_.nearest(node, opposite(d)) != ArcId::none()) return false;
    section_of_[node][d] = kNoSection;
    return true;
  }
  for (; !is_in(to); to = graph_.next(to, d)) {
    if (count == inserted.size() || exit_of(to, d) != kNone || graph_.next(to, d) == kNone) return false;
    inserted[count++] = to;
  }
  for (std::size_t i = 0; i < count; ++i) section_of_[inserted[i]][d] = section;
  return true;
}

}  // namespace reeb
