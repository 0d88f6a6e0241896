// A Reeb graph that can be changed, for the models of simplification: a set of nodes, a multiset of
// arcs, and everything else found by looking at all of them.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::test {

// Nodes keep the numbers that they have in the graph it is made of, so numbers compare as the
// total order does.
class PlainGraph {
 public:
  using Node = std::uint32_t;
  using Path = std::vector<Node>;

  explicit PlainGraph(const ReebGraph& graph);

  // The other ends of the arcs up from, and down from, a node; ascending, parallel arcs repeat.
  std::vector<Node> up(Node node) const;
  std::vector<Node> down(Node node) const;
  const std::set<Node>& nodes() const { return nodes_; }
  bool has_arc(Node lo, Node hi) const { return arcs_.contains({lo, hi}); }

  // Whether a path of arcs upward leads from one to the other; from == to does.
  bool leads_up(Node from, Node to) const;
  // The nodes among those `allowed` that are connected with `start` through allowed nodes.
  std::set<Node> component(Node start, const std::function<bool(Node)>& allowed) const;

  // Takes away one arc. THROWS: std::logic_error if there is none.
  void remove_arc(Node lo, Node hi);
  // Makes one monotone path of two: nodes of both in order, arcs between neighbours. The paths
  // start in the same node, and the one that ends lower (or both) ends on the merged path.
  void zip(const Path& first, const Path& second);
  // Takes away a leaf with its arc, or any node that has no arcs left.
  void remove_node(Node node);
  // (1, 1) nodes disappear.
  void contract_regular_nodes();

  // Upside down: what was highest is lowest.
  PlainGraph flipped() const;

  ReebGraph graph() const;

 private:
  const ReebGraph* full_;
  bool upside_down_ = false;
  std::set<Node> nodes_;
  std::multiset<std::pair<Node, Node>> arcs_;

  Node flip(Node node) const;
};

}  // namespace reeb::test
