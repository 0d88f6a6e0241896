// A Reeb graph that can be changed, for the models of simplification: a set of nodes and a multiset of arcs. Everything
// else is found by going through all of them.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::test {

// Nodes have the numbers of the graph that it was made from, so comparing numbers is comparing in the total order.
class PlainGraph {
 public:
  using Node = std::uint32_t;
  using Path = std::vector<Node>;

  // A point that is followed while the graph changes: a node of the full graph, or a vertex between two of them.
  struct Point {
    double place = 0;  // of a node its number; of a vertex, more than that of the last node before it, by less than 1
    Node lo = 0, hi = 0;  // the arc on which it lies, if it is no node
    bool is_node = false, is_dropped = false;
  };

  explicit PlainGraph(const ReebGraph& graph, std::vector<Point> points = {});
  const std::vector<Point>& points() const { return points_; }
  // Whether a path took one of several parallel arcs with points on them. Then it is not known which of the points it
  // took.
  bool is_ambiguous() const { return ambiguous_; }

  // The other ends of the arcs up from, and down from, a node; ascending, parallel arcs repeat.
  std::vector<Node> up(Node node) const;
  std::vector<Node> down(Node node) const;
  const std::set<Node>& nodes() const { return nodes_; }
  bool has_arc(Node lo, Node hi) const { return arcs_.contains({lo, hi}); }

  // Whether a rising path leads from one node to the other; true if they are equal.
  bool leads_up(Node from, Node to) const;
  // The nodes among those `allowed` that are connected with `start` through allowed nodes.
  std::set<Node> component(Node start, const std::function<bool(Node)>& allowed) const;

  void add_arc(Node lo, Node hi) { arcs_.emplace(lo, hi); }
  // Removes one of the arcs between the nodes. THROWS: std::logic_error if there is none.
  void remove_arc(Node lo, Node hi);
  // Zips two monotone paths that start in the same node: the nodes of both come in order, with arcs between neighbours.
  // The path that ends lower ends at a node of the zipped path.
  void zip(const Path& first, const Path& second);
  // Moves the points on two such paths as zip() does, and leaves the graph as it is.
  void zip_points(const Path& first, const Path& second);
  // The points of the arc have no place any more.
  void drop_points(Node lo, Node hi);
  // Removes a leaf with its arc, or a node without arcs.
  void remove_node(Node node);
  // Contracts all (1, 1) nodes.
  void contract_regular_nodes();

  // The graph turned upside down: the highest node becomes the lowest.
  PlainGraph flipped() const;

  ReebGraph graph() const;

 private:
  const ReebGraph* full_;
  bool upside_down_ = false;
  std::set<Node> nodes_;
  std::multiset<std::pair<Node, Node>> arcs_;
  std::vector<Point> points_;
  bool ambiguous_ = false;

  Node flip(Node node) const;
};

}  // namespace reeb::test
