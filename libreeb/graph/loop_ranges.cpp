#include "libreeb/graph/loop_ranges.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace reeb {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// A forest of vertices, which are nodes and arcs of the graph: a link-cut tree (Sleator and Tarjan 1983, with splay
// trees). Each preferred path is a splay tree, ordered from the root of its tree downwards.
class PathForest {
 public:
  PathForest(std::size_t vertices, std::vector<double>& ranges, std::size_t first_arc)
      : vertices_(vertices), ranges_(ranges), first_arc_(first_arc) {}

  void set_weight(std::uint32_t v, std::uint32_t weight) { vertices_[v].weight = weight; }

  bool connected(std::uint32_t x, std::uint32_t y) {
    expose(x);
    expose(y);
    return x == y || vertices_[x].parent != kNone;
  }
  // REQUIRES: not connected.
  void link(std::uint32_t x, std::uint32_t y) {
    make_root(x);
    vertices_[x].parent = y;
  }
  // REQUIRES: an edge between them.
  void cut(std::uint32_t x, std::uint32_t y) {
    make_root(x);
    expose(y);
    vertices_[y].child[0] = kNone;
    vertices_[x].parent = kNone;
    refresh(y);
  }
  // The vertex of least weight on the path. REQUIRES: connected.
  std::uint32_t lightest(std::uint32_t x, std::uint32_t y) {
    make_root(x);
    expose(y);
    return vertices_[y].lightest == kNone ? y : vertices_[y].lightest;
  }
  // Lowers the ranges of the arcs on the path to this one at most.
  void lower(std::uint32_t x, std::uint32_t y, double range) {
    make_root(x);
    expose(y);
    lower_tree(y, range);
  }
  // Passes on what was put off for whole paths. Ranges are right after this.
  void finish() {
    std::vector<std::uint32_t> path;
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) push_from_root(v, path);
  }

 private:
  struct Vertex {
    std::uint32_t parent = kNone;  // in the splay tree, or of the whole path for its root
    std::uint32_t child[2] = {kNone, kNone};
    std::uint32_t weight = kNone;                            // of an arc
    std::uint32_t lightest = kNone;                          // in the subtree
    bool flipped = false;                                    // the children, and all below, are to be swapped
    double range = std::numeric_limits<double>::infinity();  // for all of the subtree, not yet passed on
  };

  bool is_root(std::uint32_t v) const {
    const std::uint32_t p = vertices_[v].parent;
    return p == kNone || (vertices_[p].child[0] != v && vertices_[p].child[1] != v);
  }
  void lower_tree(std::uint32_t v, double range) {
    if (v == kNone) return;
    if (v >= first_arc_) ranges_[v - first_arc_] = std::min(ranges_[v - first_arc_], range);
    vertices_[v].range = std::min(vertices_[v].range, range);
  }
  void push(std::uint32_t v) {
    Vertex& vertex = vertices_[v];
    if (vertex.flipped) {
      vertex.flipped = false;
      std::swap(vertex.child[0], vertex.child[1]);
      for (const std::uint32_t c : vertex.child)
        if (c != kNone) vertices_[c].flipped = !vertices_[c].flipped;
    }
    if (vertex.range < std::numeric_limits<double>::infinity()) {
      for (const std::uint32_t c : vertex.child) lower_tree(c, vertex.range);
      vertex.range = std::numeric_limits<double>::infinity();
    }
  }
  void push_from_root(std::uint32_t v, std::vector<std::uint32_t>& path) {
    path.assign(1, v);
    while (!is_root(path.back())) path.push_back(vertices_[path.back()].parent);
    for (; !path.empty(); path.pop_back()) push(path.back());
  }
  void refresh(std::uint32_t v) {
    Vertex& vertex = vertices_[v];
    vertex.lightest = vertex.weight == kNone ? kNone : v;
    for (const std::uint32_t c : vertex.child) {
      if (c == kNone || vertices_[c].lightest == kNone) continue;
      const std::uint32_t other = vertices_[c].lightest;
      if (vertex.lightest == kNone || vertices_[other].weight < vertices_[vertex.lightest].weight)
        vertex.lightest = other;
    }
  }
  void rotate(std::uint32_t v) {
    const std::uint32_t p = vertices_[v].parent, g = vertices_[p].parent;
    const int side = vertices_[p].child[1] == v ? 1 : 0;
    if (!is_root(p)) vertices_[g].child[vertices_[g].child[1] == p ? 1 : 0] = v;
    vertices_[v].parent = g;
    const std::uint32_t moved = std::exchange(vertices_[v].child[1 - side], p);
    vertices_[p].child[side] = moved;
    if (moved != kNone) vertices_[moved].parent = p;
    vertices_[p].parent = v;
    refresh(p);
    refresh(v);
  }
  void splay(std::uint32_t v) {
    push_from_root(v, path_);
    while (!is_root(v)) {
      const std::uint32_t p = vertices_[v].parent, g = vertices_[p].parent;
      if (!is_root(p)) rotate((vertices_[p].child[1] == v) == (vertices_[g].child[1] == p) ? p : v);
      rotate(v);
    }
  }
  // Makes the path from the root of the tree to v the preferred one, and v the root of its splay tree.
  void expose(std::uint32_t v) {
    std::uint32_t below = kNone;
    for (std::uint32_t at = v; at != kNone; at = vertices_[at].parent) {
      splay(at);
      vertices_[at].child[1] = below;
      refresh(at);
      below = at;
    }
    splay(v);
  }
  void make_root(std::uint32_t v) {
    expose(v);
    vertices_[v].flipped = !vertices_[v].flipped;
    push(v);
  }

  std::vector<Vertex> vertices_;
  std::vector<double>& ranges_;
  std::size_t first_arc_;
  std::vector<std::uint32_t> path_;
};

// The arcs by their upper nodes.
std::vector<std::uint32_t> by_upper_node(const ReebGraph& graph) {
  std::vector<std::uint32_t> order(graph.arc_count());
  for (std::uint32_t arc = 0; arc < order.size(); ++arc) order[arc] = arc;
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return std::pair(graph.hi[a], a) < std::pair(graph.hi[b], b); });
  return order;
}

}  // namespace

// Arcs are added by upper node, ascending. The forest is one of greatest lower nodes: of each cycle that an arc closes,
// the arc of the lowest lower node leaves. The cycles with a lowest node from b and a highest node up to t that were
// closed this way are a basis of all cycles there, since they are as many and each has an arc that later ones lack. So
// an arc that is on any cycle within [b, t] is on one of them, and the least range of those is that of all cycles.
std::vector<double> loop_ranges(const ReebGraph& graph) {
  std::vector<double> ranges(graph.arc_count(), std::numeric_limits<double>::infinity());
  const auto nodes = static_cast<std::uint32_t>(graph.node_count());
  PathForest forest(graph.node_count() + graph.arc_count(), ranges, nodes);
  for (const std::uint32_t arc : by_upper_node(graph)) {
    const std::uint32_t lo = graph.lo[arc].value(), hi = graph.hi[arc].value(), own = nodes + arc;
    forest.set_weight(own, lo);
    if (forest.connected(lo, hi)) {
      const std::uint32_t lightest = forest.lightest(lo, hi), other = lightest - nodes;
      const std::uint32_t bottom = std::min(lo, graph.lo[other].value());
      // Infinity stands for no cycle.
      const double range =
          std::min(graph.nodes[hi].value - graph.nodes[bottom].value, std::numeric_limits<double>::max());
      forest.lower(lo, hi, range);
      ranges[arc] = std::min(ranges[arc], range);
      if (lo <= bottom) continue;  // the new arc is the one that leaves
      forest.cut(graph.lo[other].value(), lightest);
      forest.cut(lightest, graph.hi[other].value());
    }
    forest.link(lo, own);
    forest.link(own, hi);
  }
  forest.finish();
  for (double& range : ranges)
    if (range == std::numeric_limits<double>::infinity()) range = kNoLoop;
  return ranges;
}

}  // namespace reeb
