#include "tests/model/plain_graph.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace reeb::test {

PlainGraph::PlainGraph(const ReebGraph& graph, std::vector<Point> points) : full_(&graph), points_(std::move(points)) {
  for (Node v = 0; v < graph.node_count(); ++v) nodes_.insert(v);
  for (std::size_t i = 0; i < graph.arc_count(); ++i) arcs_.emplace(graph.lo[i].value(), graph.hi[i].value());
}

std::vector<PlainGraph::Node> PlainGraph::up(Node node) const {
  std::vector<Node> ends;
  for (const auto& [lo, hi] : arcs_)
    if (lo == node) ends.push_back(hi);
  return ends;
}

std::vector<PlainGraph::Node> PlainGraph::down(Node node) const {
  std::vector<Node> ends;
  for (const auto& [lo, hi] : arcs_)
    if (hi == node) ends.push_back(lo);
  return ends;
}

bool PlainGraph::leads_up(Node from, Node to) const {
  std::set<Node> reached{from};
  for (const auto& [lo, hi] : arcs_)  // sorted by lo, so one pass upward is enough
    if (reached.contains(lo)) reached.insert(hi);
  return reached.contains(to);
}

std::set<PlainGraph::Node> PlainGraph::component(Node start, const std::function<bool(Node)>& allowed) const {
  std::set<Node> reached{start};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const auto& [lo, hi] : arcs_) {
      if (!allowed(lo) || !allowed(hi)) continue;
      if (reached.contains(lo)) reached.insert(hi);
      if (reached.contains(hi)) reached.insert(lo);
    }
  }
  return reached;
}

void PlainGraph::remove_arc(Node lo, Node hi) {
  const auto it = arcs_.find({lo, hi});
  if (it == arcs_.end()) throw std::logic_error("no arc from " + std::to_string(lo) + " to " + std::to_string(hi));
  arcs_.erase(it);
}

void PlainGraph::zip_points(const Path& first, const Path& second) {
  std::set<Node> merged(first.begin(), first.end());
  merged.insert(second.begin(), second.end());
  for (Point& point : points_) {
    if (point.is_node || point.is_dropped) continue;
    for (const Path* path : {&first, &second}) {
      const auto lo = std::find(path->begin(), path->end(), point.lo);
      if (lo == path->end() || std::next(lo) == path->end() || *std::next(lo) != point.hi) continue;
      if (arcs_.count({point.lo, point.hi}) > 1) ambiguous_ = true;
      const auto above = std::find_if(merged.begin(), merged.end(), [&](Node node) { return node > point.place; });
      point.hi = *above;
      point.lo = *std::prev(above);
      break;
    }
  }
}

void PlainGraph::drop_points(Node lo, Node hi) {
  for (Point& point : points_)
    if (!point.is_node && point.lo == lo && point.hi == hi) point.is_dropped = true;
}

void PlainGraph::zip(const Path& first, const Path& second) {
  zip_points(first, second);
  std::set<Node> merged;
  for (const Path* path : {&first, &second}) {
    merged.insert(path->begin(), path->end());
    for (std::size_t i = 1; i < path->size(); ++i) remove_arc((*path)[i - 1], (*path)[i]);
  }
  for (auto it = merged.begin(); std::next(it) != merged.end(); ++it) arcs_.emplace(*it, *std::next(it));
}

void PlainGraph::remove_node(Node node) {
  std::erase_if(arcs_, [&](const auto& arc) { return arc.first == node || arc.second == node; });
  nodes_.erase(node);
}

void PlainGraph::contract_regular_nodes() {
  const std::set<Node> all = nodes_;
  for (const Node node : all) {
    const std::vector<Node> below = down(node), above = up(node);
    if (below.size() != 1 || above.size() != 1) continue;
    remove_node(node);
    arcs_.emplace(below.front(), above.front());
    for (Point& point : points_) {
      const bool is_this = point.is_node && point.place == node;
      if (is_this || (!point.is_node && point.hi == node)) point.hi = above.front();
      if (is_this || (!point.is_node && point.lo == node)) point.lo = below.front();
      if (is_this) point.is_node = false;
    }
  }
}

PlainGraph::Node PlainGraph::flip(Node node) const { return static_cast<Node>(full_->node_count()) - 1 - node; }

PlainGraph PlainGraph::flipped() const {
  PlainGraph result = *this;
  result.upside_down_ = !upside_down_;
  result.nodes_.clear();
  result.arcs_.clear();
  for (const Node node : nodes_) result.nodes_.insert(flip(node));
  for (const auto& [lo, hi] : arcs_) result.arcs_.emplace(flip(hi), flip(lo));
  for (Point& point : result.points_) {
    point.place = static_cast<double>(full_->node_count()) - 1 - point.place;
    std::swap(point.lo, point.hi);
    point.lo = flip(point.lo);
    point.hi = flip(point.hi);
  }
  return result;
}

ReebGraph PlainGraph::graph() const {
  if (upside_down_) return flipped().graph();
  const std::vector<Node> order(nodes_.begin(), nodes_.end());
  const auto number = [&](Node node) {
    const auto it = std::lower_bound(order.begin(), order.end(), node);
    return NodeId(static_cast<std::uint32_t>(it - order.begin()));
  };
  ReebGraph result;
  for (const Node node : order) {
    result.nodes.push_back(full_->nodes[node]);
    if (!full_->positions.empty()) result.positions.push_back(full_->positions[node]);
  }
  for (const auto& [lo, hi] : arcs_) {
    result.lo.push_back(number(lo));
    result.hi.push_back(number(hi));
  }
  return result;
}

}  // namespace reeb::test
