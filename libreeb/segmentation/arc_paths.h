// The arcs over which an edge of the mesh runs, found from the places of its ends.
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb {

// A point of a graph: a node, or a point between the ends of an arc.
struct GraphPlace {
  std::uint32_t number = 0;  // of the node or the arc
  bool is_node = false;
};

// An edge of the mesh is mapped to a monotone path. If only one such path joins two places, it is that of every edge
// between them. Two paths differ by a loop whose height is at most that of the edge.
//
// TIME:   that of what lies between the ends: what is reached from the lower one and leads above the upper one, up to
//         kMostNodes.
// MEMORY: kNodeBytes per node, kArcBytes per arc.
class ArcPaths {
 public:
  static constexpr std::uint64_t kNodeBytes = 24, kArcBytes = 1;
  static constexpr std::size_t kMostNodes = 1000;

  // REQUIRES: `graph` outlives this.
  explicit ArcPaths(const ReebGraph& graph);

  // Replaces `path` by the arcs of the only monotone path between two nodes, from below. If there is none, or more than
  // one, or that is not known after kMostNodes: returns false, and all arcs that could be on it are doubtful.
  bool find(NodeId from, NodeId to, std::vector<ArcId>& path);
  // Whether the arc can be part of a path that find() did not find. Asked after the last find().
  std::vector<bool> doubtful() const;

 private:
  void doubt_all_between(std::uint32_t from, std::uint32_t to) { ++spans_[from], --spans_[to]; }

  const ReebGraph& graph_;
  std::vector<std::uint32_t> first_arc_;  // by node: the first of the arcs that go up from it
  std::vector<NodeId> highest_;           // by node: the highest node to which a path leads up
  std::vector<std::uint32_t> reached_;    // by node: the number of the search that reached it last
  std::vector<std::uint32_t> leads_;      // by node: the number of the search in which it led to the upper end
  std::vector<std::int64_t> spans_;       // by node: spans of doubt that begin here, less those that end here
  std::vector<bool> doubtful_;            // by arc
  std::uint32_t search_ = 0;
  std::vector<std::uint32_t> nodes_;  // that the present search reached
};

}  // namespace reeb
