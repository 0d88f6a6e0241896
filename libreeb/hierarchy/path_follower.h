// Follows paths that take the nearest arc at each node, past many nodes at once.
//
// WHY. Long arcs have all that ever hung on them as nodes: the ways past them that cancelling goes make
// up a few per cent of all ways, but nearly all of the steps, time and again along the same nodes.
//
// So what was followed node by node is kept as stretches, consecutive nodes of a path from each of which
// it leads to one exit. A stretch outlives the nodes that disappear from its path, and takes in a few
// that are put between; else it breaks, and its nodes are followed one by one the next time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// MEMORY: 8.5 bytes a node of the graph.
class PathFollower {
 public:
  explicit PathFollower(const WorkingGraph& graph);

  // To be called when the nearest arc of a node in direction d is another one, or ends elsewhere.
  // May be called while more changes are to come, up to the next follow() or heed_changes().
  void note(NodeId node, Direction d) {
    if (exit_of(node, d) != kNone) changed_.push_back({node, d});
  }
  // Forgets what was noted, once it is clear what that means. To be called now and then, for what is noted
  // is held until then.
  void heed_changes();

  void prefetch(NodeId node) const { __builtin_prefetch(&stretch_of_[node]); }

  // The last node of the path from `node` in direction d that `passes`, or `node` itself.
  // REQUIRES: the node has arcs; after one that does not pass none does.
  template <class Passes>
  NodeId follow(NodeId node, Direction d, Passes passes);

 private:
  static constexpr NodeId kNone = NodeId::none();
  static constexpr std::uint32_t kNoStretch = 0;
  static constexpr std::size_t kLeastNodes = 8, kMostNodes = 32;  // of a stretch
  static constexpr std::size_t kMostPutBetween = 4;

  struct Change {
    NodeId node;
    Direction direction;
  };

  NodeId exit_of(NodeId node, Direction d) const { return exits_[stretch_of_[node][d]]; }
  NodeId next(NodeId node, Direction d) const {
    const ArcId arc = graph_.nearest(node, d);
    return arc == ArcId::none() ? kNone : graph_.end(arc, d);
  }
  void keep_followed(NodeId exit, Direction d);
  bool still_leads_on(NodeId node, Direction d);

  const WorkingGraph& graph_;
  IdVector<NodeId, std::array<std::uint32_t, 2>> stretch_of_;  // by direction
  std::vector<NodeId> exits_;                                  // by stretch; kNone if it broke
  std::vector<Change> changed_;                                // nodes of stretches, not yet heeded
  std::vector<NodeId> followed_;                               // one by one, of no stretch
};

template <class Passes>
NodeId PathFollower::follow(NodeId node, Direction d, Passes passes) {
  heed_changes();
  followed_.clear();
  while (true) {
    const NodeId exit = exit_of(node, d);
    if (exit == kNone) {
      if (followed_.size() == kMostNodes) keep_followed(node, d);
      followed_.push_back(node);
    } else {
      keep_followed(node, d);
      if (passes(exit)) {
        node = exit;
        continue;
      }
    }
    const NodeId to = next(node, d);
    if (to == kNone || !passes(to)) break;
    node = to;
  }
  keep_followed(node, d);
  return node;
}

}  // namespace reeb
