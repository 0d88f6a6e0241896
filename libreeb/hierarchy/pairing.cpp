#include "libreeb/hierarchy/pairing.h"

#include <algorithm>
#include <tuple>

#include "libreeb/base/union_find.h"
#include "libreeb/hierarchy/bottleneck_forest.h"

namespace reeb {
namespace {

// The arcs grouped by upper end: the arcs down from node y are order[first[y]] .. order[first[y + 1] - 1].
struct ArcsBelow {
  std::vector<std::uint32_t> first, order;
};

ArcsBelow arcs_below(const ReebGraph& graph) {
  ArcsBelow below{std::vector<std::uint32_t>(graph.node_count() + 1), std::vector<std::uint32_t>(graph.arc_count())};
  for (const NodeId hi : graph.hi) ++below.first[hi.value()];
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : below.first) sum += std::exchange(entry, sum);
  for (std::uint32_t arc = 0; arc < graph.arc_count(); ++arc) below.order[below.first[graph.hi[arc].value()]++] = arc;
  std::rotate(below.first.begin(), below.first.end() - 1, below.first.end());
  below.first[0] = 0;
  return below;
}

// Upward sweep. An arc down from y either joins two components of the sublevel set, and the one whose minimum is higher
// ends (elder rule), or it closes a cycle. Why y is then paired with the lower end of the arc that a maximum spanning
// forest, by lower end, loses: the number of independent cycles within [a, b] is the number of Ext1 pairs there. Of the
// arcs with hi <= b, those that the forest keeps and whose lower end is at least a are a spanning forest of [a, b], for
// every a. Returns the components of the whole graph, named by their minima.
UnionFind sweep_up(const ReebGraph& graph, std::vector<PersistencePair>& pairs, const Poll& poll) {
  constexpr std::uint32_t kNodesBetweenPolls = 1u << 14;
  const ArcsBelow below = arcs_below(graph);
  const auto nodes = static_cast<std::uint32_t>(graph.node_count());
  UnionFind sublevel(nodes);
  BottleneckForest forest(nodes);
  for (std::uint32_t y = 0; y < nodes; ++y) {
    if (poll && y % kNodesBetweenPolls == 0) poll(static_cast<double>(y) / nodes);
    for (std::uint32_t i = below.first[y]; i < below.first[y + 1]; ++i) {
      const std::uint32_t x = graph.lo[below.order[i]].value();
      const std::uint32_t lost = forest.insert(x, y, x);
      if (lost != BottleneckForest::kNone) {
        pairs.push_back({NodeId(lost), NodeId(y), PairType::kExt1});
        continue;
      }
      const std::uint32_t younger = std::max(sublevel.find(x), sublevel.find(y));
      if (younger != y) pairs.push_back({NodeId(younger), NodeId(y), PairType::kOrd0});
      sublevel.unite(x, y);
    }
  }
  return sublevel;
}

// Downward sweep, in ranks counted from the top, so that a superlevel component is named by its maximum. Arcs are
// already sorted by lower end.
UnionFind sweep_down(const ReebGraph& graph, std::vector<PersistencePair>& pairs) {
  const auto nodes = static_cast<std::uint32_t>(graph.node_count());
  const auto flip = [nodes](std::uint32_t node) { return nodes - 1 - node; };
  UnionFind superlevel(nodes);
  for (std::size_t arc = graph.arc_count(); arc-- > 0;) {
    const std::uint32_t v = flip(graph.lo[arc].value());
    const std::uint32_t x = superlevel.find(flip(graph.hi[arc].value()));
    const std::uint32_t own = superlevel.find(v);
    if (x == own) continue;
    const std::uint32_t younger = std::max(x, own);
    if (younger != v) pairs.push_back({graph.lo[arc], NodeId(flip(younger)), PairType::kRel1});
    superlevel.unite(x, own);
  }
  return superlevel;
}

int rank_of(PairType type) {
  switch (type) {
    case PairType::kExt1:
      return 0;
    case PairType::kOrd0:
      return 1;
    case PairType::kRel1:
      return 2;
    case PairType::kExt0:
      return 3;
  }
  return 3;
}

}  // namespace

void sort_for_cancelling(const ReebGraph& graph, std::vector<PersistencePair>& pairs) {
  struct Keyed {
    double persistence;
    PersistencePair pair;
  };
  std::vector<Keyed> keyed;
  keyed.reserve(pairs.size());
  for (const PersistencePair& pair : pairs) keyed.push_back({persistence_of(graph, pair), pair});
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    const auto key = [](const Keyed& k) {
      return std::tuple(k.pair.type == PairType::kExt0, k.persistence, k.pair.hi);
    };
    const auto ka = key(a), kb = key(b);
    if (ka != kb) return ka < kb;
    if (a.pair.lo != b.pair.lo) return b.pair.lo < a.pair.lo;
    return rank_of(a.pair.type) < rank_of(b.pair.type);
  });
  std::transform(keyed.begin(), keyed.end(), pairs.begin(), [](const Keyed& k) { return k.pair; });
}

std::vector<PersistencePair> persistence_pairs(const ReebGraph& graph, const Poll& poll) {
  std::vector<PersistencePair> pairs;
  UnionFind sublevel = sweep_up(graph, pairs, poll);
  UnionFind superlevel = sweep_down(graph, pairs);
  const auto nodes = static_cast<std::uint32_t>(graph.node_count());
  for (std::uint32_t x = 0; x < nodes; ++x)
    if (sublevel.find(x) == x)
      pairs.push_back({NodeId(x), NodeId(nodes - 1 - superlevel.find(nodes - 1 - x)), PairType::kExt0});
  sort_for_cancelling(graph, pairs);
  return pairs;
}

}  // namespace reeb
