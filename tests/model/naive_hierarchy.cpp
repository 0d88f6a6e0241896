#include "tests/model/naive_hierarchy.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "tests/model/plain_graph.h"

namespace reeb::test {
namespace {

using Node = PlainGraph::Node;
using Path = PlainGraph::Path;

// Persistence, then hi ascending, then lo descending, then Ext1 < Ord0 < Rel1.
void sort_for_cancelling(const ReebGraph& graph, std::vector<PersistencePair>& pairs) {
  std::sort(pairs.begin(), pairs.end(), [&](const PersistencePair& a, const PersistencePair& b) {
    const bool last_a = a.type == PairType::kExt0, last_b = b.type == PairType::kExt0;
    return std::tuple(last_a, persistence(graph, a), a.hi, b.lo, a.type) <
           std::tuple(last_b, persistence(graph, b), b.hi, a.lo, b.type);
  });
}

// The path up from `from` to `to` that goes, at each choice, to the lowest node that still leads to `to`.
Path lowest_path(const PlainGraph& graph, Node from, Node to) {
  Path path{from};
  while (path.back() != to) {
    const std::vector<Node> choices = graph.up(path.back());
    const auto next = std::find_if(choices.begin(), choices.end(), [&](Node node) { return graph.leads_up(node, to); });
    if (next == choices.end()) throw std::logic_error("no monotone path to the upper node");
    path.push_back(*next);
  }
  return path;
}

// Rel1 (v, u).
void cancel_maximum(PlainGraph& graph, Node v, Node u) {
  const std::set<Node> own = graph.component(u, [&](Node node) { return node > v; });
  const Path first = lowest_path(graph, v, u);
  Path second{v};
  const std::vector<Node> starts = graph.up(v);
  const auto outside = std::find_if(starts.begin(), starts.end(), [&](Node node) { return !own.contains(node); });
  if (outside == starts.end()) throw std::logic_error("the up-fork has no other component");
  second.push_back(*outside);
  while (second.back() < u) {
    const std::vector<Node> choices = graph.up(second.back());
    if (choices.empty()) throw std::logic_error("the other path ends below the maximum");
    second.push_back(choices.front());
  }
  graph.zip(first, second);
}

// Monotone paths from v to y: the first in each component of the open interlevel set, in order.
std::vector<Path> interlevel_paths(const PlainGraph& graph, Node v, Node y) {
  std::vector<Path> paths;
  std::set<Node> seen;
  for (const Node start : graph.up(v)) {  // ascending, so a component's first start comes first
    if (start >= y || seen.contains(start) || !graph.leads_up(start, y)) continue;
    seen.merge(graph.component(start, [&](Node node) { return v < node && node < y; }));
    Path path{v};
    for (const Node node : lowest_path(graph, start, y)) path.push_back(node);
    paths.push_back(std::move(path));
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

// Ext1 (v, y). False if the loop is kept.
bool cancel_loop(PlainGraph& graph, Node v, Node y) {
  // Removing the arc is the same as zipping it onto another path, since it has no inner nodes.
  if (graph.has_arc(v, y)) {
    graph.remove_arc(v, y);
    const bool has_other = graph.leads_up(v, y);
    const Path other = has_other ? lowest_path(graph, v, y) : Path{v, y};
    graph.add_arc(v, y);
    if (!has_other)
      graph.drop_points(v, y);
    else if (other.size() > 2)
      graph.zip_points(other, {v, y});
    graph.remove_arc(v, y);
    return true;
  }
  const std::vector<Path> paths = interlevel_paths(graph, v, y);
  if (paths.size() < 2) return false;
  graph.zip(paths[0], paths[1]);
  return true;
}

// False if the pair is kept.
bool cancel(PlainGraph& graph, const PersistencePair& pair, std::size_t node_count) {
  const Node lo = pair.lo.value(), hi = pair.hi.value();
  if (pair.type == PairType::kExt1) return cancel_loop(graph, lo, hi);
  if (pair.type == PairType::kRel1) {
    cancel_maximum(graph, lo, hi);
    return true;
  }
  const Node top = static_cast<Node>(node_count) - 1;
  graph = graph.flipped();
  cancel_maximum(graph, top - hi, top - lo);
  graph = graph.flipped();
  return true;
}

}  // namespace

double persistence(const ReebGraph& graph, const PersistencePair& pair) {
  return graph.nodes[pair.hi.value()].value - graph.nodes[pair.lo.value()].value;
}

NaiveHierarchy naive_hierarchy(const ReebGraph& graph, std::vector<PersistencePair> pairs,
                               std::vector<PlainGraph::Point> points) {
  sort_for_cancelling(graph, pairs);
  NaiveHierarchy result;
  result.versions.push_back(graph);
  PlainGraph current(graph, std::move(points));
  result.points.push_back(current.points());
  result.ambiguous.push_back(false);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].type == PairType::kExt0) continue;
    pairs[i].kept = !cancel(current, pairs[i], graph.node_count());
    if (pairs[i].kept) continue;
    current.contract_regular_nodes();
    result.versions.push_back(current.graph());
    result.steps.push_back(i);
    result.points.push_back(current.points());
    result.ambiguous.push_back(current.is_ambiguous());
  }
  result.pairs = std::move(pairs);
  return result;
}

std::size_t NaiveHierarchy::version_below(double t, const ReebGraph& full) const {
  const auto above =
      std::find_if(steps.begin(), steps.end(), [&](std::size_t pair) { return !(persistence(full, pairs[pair]) < t); });
  return static_cast<std::size_t>(above - steps.begin());
}

}  // namespace reeb::test
