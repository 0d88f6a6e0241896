// The two sweeps that pair the nodes of a graph, arc by arc (docs/SEMANTICS.md, Pairs), and the order of cancelling.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "libreeb/base/work.h"
#include "libreeb/containers/union_find.h"
#include "libreeb/graph/bottleneck_forest.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb {

// Upward sweep. An arc down from y either joins two components of the sublevel set, and the one whose minimum is higher
// ends (elder rule), or it closes a cycle. Why y is then paired with the lower end of the arc that a maximum spanning
// forest, by lower end, loses: the number of independent cycles within [a, b] is the number of Ext1 pairs there. Of the
// arcs with hi <= b, those that the forest keeps and whose lower end is at least a are a spanning forest of [a, b], for
// every a.
//
// MEMORY: 12 bytes per node.
class UpSweep {
 public:
  explicit UpSweep(std::uint32_t nodes) : sublevel_(nodes), forest_(nodes) {}

  // The next arc, in an order in which upper ends do not fall. Calls pair(PersistencePair) if there is one.
  template <class Pair>
  void add(std::uint32_t x, std::uint32_t y, const Pair& pair) {
    const std::uint32_t lost = forest_.insert(x, y, x);
    if (lost != BottleneckForest::kNone) {
      pair(PersistencePair{NodeId(lost), NodeId(y), PairType::kExt1});
      return;
    }
    const std::uint32_t younger = std::max(sublevel_.find(x), sublevel_.find(y));
    if (younger != y) pair(PersistencePair{NodeId(younger), NodeId(y), PairType::kOrd0});
    sublevel_.unite(x, y);
  }
  // To be called some time before an arc from x up is added.
  void prefetch(std::uint32_t x) const {
    forest_.prefetch(x);
    sublevel_.prefetch(x);
  }
  // Whether the node is the minimum of a component of what was added.
  bool is_minimum(std::uint32_t node) const { return sublevel_.is_least(node); }

 private:
  UnionFind sublevel_;
  BottleneckForest forest_;
};

// Downward sweep, in ranks counted from the top, so that a superlevel component is named by its maximum.
//
// MEMORY: 4 bytes per node.
class DownSweep {
 public:
  explicit DownSweep(std::uint32_t nodes) : nodes_(nodes), superlevel_(nodes) {}

  // The next arc, in an order in which lower ends do not rise.
  template <class Pair>
  void add(NodeId lo, NodeId hi, const Pair& pair) {
    const std::uint32_t v = flip(lo.value());
    const std::uint32_t x = superlevel_.find(flip(hi.value()));
    const std::uint32_t own = superlevel_.find(v);
    if (x == own) return;
    const std::uint32_t younger = std::max(x, own);
    if (younger != v) pair(PersistencePair{lo, NodeId(flip(younger)), PairType::kRel1});
    superlevel_.unite(x, own);
  }
  // To be called some time before an arc up to `hi` is added.
  void prefetch(NodeId hi) const { superlevel_.prefetch(flip(hi.value())); }
  // The maximum of a component of what was added.
  std::uint32_t maximum(std::uint32_t node) { return flip(superlevel_.find(flip(node))); }

 private:
  std::uint32_t flip(std::uint32_t node) const { return nodes_ - 1 - node; }

  std::uint32_t nodes_;
  UnionFind superlevel_;
};

// Calls pair(PersistencePair) for each component. REQUIRES: all arcs were added to both sweeps.
template <class Pair>
void pair_components(std::uint32_t nodes, const UpSweep& up, DownSweep& down, const Pair& pair) {
  for (std::uint32_t x = 0; x < nodes; ++x)
    if (up.is_minimum(x)) pair(PersistencePair{NodeId(x), NodeId(down.maximum(x)), PairType::kExt0});
}

// A pair with what it is sorted by first.
struct RankedPair {
  double persistence;
  PersistencePair pair;
};

// The order of cancelling, as persistence_pairs() says.
inline bool is_cancelled_before(const RankedPair& a, const RankedPair& b) {
  const auto rank_of = [](PairType type) {
    constexpr int kRanks[] = {3, 0, 1, 2};  // of Ext0, Ext1, Ord0, Rel1
    return kRanks[static_cast<std::size_t>(type)];
  };
  const bool is_a_last = a.pair.type == PairType::kExt0, is_b_last = b.pair.type == PairType::kExt0;
  if (is_a_last != is_b_last) return is_b_last;
  if (a.persistence != b.persistence) return a.persistence < b.persistence;
  if (a.pair.hi != b.pair.hi) return a.pair.hi < b.pair.hi;
  if (a.pair.lo != b.pair.lo) return b.pair.lo < a.pair.lo;
  return rank_of(a.pair.type) < rank_of(b.pair.type);
}

// Sorts pairs into the order of cancelling.
void sort_for_cancelling(const ReebGraph& graph, std::vector<PersistencePair>& pairs);

// persistence_pairs() in two parts. The upward sweep takes longer than the downward one, whose thread then sorts what
// it found.
//
// MEMORY: without the result, 4 bytes per arc and 20 bytes per node; with it, up to 36 bytes per pair.
// THREADS: `poll` is called in this one.
struct SweptPairs {
  std::vector<PersistencePair> rising, components;  // Ord0 and Ext1, Ext0
  std::vector<RankedPair> falling;                  // Rel1, in the order of cancelling
};
SweptPairs swept_pairs(const ReebGraph& graph, const Poll& poll, const DoBoth& both);
// MEMORY: 36 bytes per pair, 12 of them the result.
std::vector<PersistencePair> sorted_pairs(const ReebGraph& graph, SweptPairs pairs);

}  // namespace reeb
