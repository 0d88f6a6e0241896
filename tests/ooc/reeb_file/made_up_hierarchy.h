// Random graphs with hierarchies that obey the rules of versions but have no topological meaning: every step removes
// arcs and adds fewer between nodes that are still there.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/subgraph.h"

namespace reeb {

struct MadeUp {
  static constexpr int kBucketExponent = -3;

  ReebGraph graph;
  Hierarchy hierarchy;
  ArcBuckets buckets;  // of hierarchy.arcs

  // The vertices of the full graph: its nodes, and the vertices in the buckets of its arcs.
  std::uint64_t vertices() const {
    std::uint64_t sum = graph.node_count();
    for (std::size_t i = 0; i < hierarchy.arcs.size(); ++i)
      if (hierarchy.arcs[i].born == 0)
        for (const Bucket& bucket : buckets.view().of(i)) sum += bucket.count;
    return sum;
  }
};

class MadeUpMaker {
 public:
  explicit MadeUpMaker(std::uint64_t seed) : random_(seed) {}

  MadeUp make(std::uint32_t nodes, std::uint32_t arcs, std::uint32_t steps) {
    MadeUp result;
    make_graph_of(nodes, arcs, result);
    for (std::size_t i = 0; i < result.graph.arc_count(); ++i) {
      result.hierarchy.arcs.push_back({result.graph.lo[i], result.graph.hi[i], 0, kNeverDies});
      live_.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::uint32_t step = 1; step <= steps && live_.size() > 4; ++step) cancel(step, result.hierarchy);
    make_pairs(result);
    result.hierarchy.isolated = isolated_nodes(result.graph);
    result.buckets.offsets.push_back(0);
    for (const ArcVersion& arc : result.hierarchy.arcs) add_buckets(result, arc);
    return result;
  }

 private:
  std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(random_() % n); }
  double real() { return static_cast<double>(random_() >> 11) * 0x1p-53 - 0.25; }

  void make_graph_of(std::uint32_t nodes, std::uint32_t arcs, MadeUp& result) {
    std::set<std::uint64_t> vertices;
    while (vertices.size() < nodes) vertices.insert(random_() % (std::uint64_t{nodes} * 50 + 1));
    std::vector<SweepKey> keys;
    // A few values repeat, so that ties occur.
    for (const std::uint64_t v : vertices) keys.push_back({below(4) == 0 ? 0.5 : real(), VertexId(v)});
    std::vector<ArcKeys> ends;
    for (std::uint32_t i = 0; nodes > 1 && i < arcs; ++i) {
      const SweepKey a = keys[below(keys.size())], b = keys[below(keys.size())];
      if (a == b) continue;
      ends.push_back(a < b ? ArcKeys{a, b} : ArcKeys{b, a});
    }
    result.graph = make_graph(ends, keys);  // nodes without arcs are isolated
    for (std::size_t i = 0; i < result.graph.node_count(); ++i)
      result.graph.positions.push_back({real(), static_cast<float>(real()), -0.0});
  }

  void cancel(std::uint32_t step, Hierarchy& hierarchy) {
    const std::uint32_t removed = 2 + below(2);
    for (std::uint32_t k = 0; k < removed; ++k) {
      const std::uint32_t place = below(live_.size());
      ArcVersion& arc = hierarchy.arcs[live_[place]];
      arc.died = step;
      live_[place] = live_.back();
      live_.pop_back();
    }
    if (below(3) != 0) {
      const NodeId a = hierarchy.arcs[live_[below(live_.size())]].lo;
      const NodeId b = hierarchy.arcs[live_[below(live_.size())]].hi;
      if (a < b) {
        hierarchy.arcs.push_back({a, b, step, kNeverDies});
        live_.push_back(static_cast<std::uint32_t>(hierarchy.arcs.size() - 1));
      }
    }
    const double last = hierarchy.persistence.empty() ? 0.0 : hierarchy.persistence.back();
    hierarchy.persistence.push_back(last + (below(3) == 0 ? 0.0 : 0.001 * below(10)));
  }

  // As many Ext0 pairs as components and Ext1 pairs as loops, as verify() requires; ends are arbitrary.
  void make_pairs(MadeUp& result) {
    const BettiNumbers betti = betti_numbers(result.graph);
    const auto random_pair = [&](PairType type) {
      NodeId a(below(result.graph.node_count())), b(below(result.graph.node_count()));
      if (b < a) std::swap(a, b);
      result.hierarchy.pairs.push_back({a, b, type, type == PairType::kExt1 && below(5) == 0});
    };
    for (std::uint64_t i = 0; i < betti.loops; ++i) random_pair(PairType::kExt1);
    for (std::uint32_t i = below(20); i > 0 && result.graph.node_count() > 0; --i)
      random_pair(below(2) == 0 ? PairType::kOrd0 : PairType::kRel1);
    for (std::uint64_t i = 0; i < betti.components; ++i) random_pair(PairType::kExt0);
  }

  // Adds some of the buckets between the arc's ends. Arcs that are born later have fewer than the arcs that they
  // replace.
  void add_buckets(MadeUp& result, const ArcVersion& arc) {
    const auto index = [&](NodeId node) {
      return bucket_index(result.graph.nodes[node.value()].value, MadeUp::kBucketExponent);
    };
    ArcBuckets& buckets = result.buckets;
    for (std::int64_t i = index(arc.lo); i <= index(arc.hi) && (arc.born == 0 || i == index(arc.lo)); ++i)
      if (below(3) != 0)
        buckets.buckets.push_back({i, arc.born != 0 ? 1 : 1 + random_() % 1000, {real(), real(), real()}});
    buckets.offsets.push_back(buckets.buckets.size());
  }

  std::mt19937_64 random_;
  std::vector<std::uint32_t> live_;
};

// The level by definition: arcs with born <= version < died, nodes with such arcs, and the nodes
// that no record names.
inline ReebGraph naive_level(const MadeUp& made, std::uint32_t version) {
  std::vector<bool> named(made.graph.node_count()), present(made.graph.node_count());
  std::vector<ArcKeys> arcs;
  for (const ArcVersion& arc : made.hierarchy.arcs) {
    named[arc.lo.value()] = named[arc.hi.value()] = true;
    if (arc.born > version || version >= arc.died) continue;
    arcs.push_back({made.graph.nodes[arc.lo.value()], made.graph.nodes[arc.hi.value()]});
  }
  std::vector<SweepKey> isolated;
  for (std::size_t i = 0; i < named.size(); ++i)
    if (!named[i]) isolated.push_back(made.graph.nodes[i]);
  ReebGraph graph = make_graph(arcs, isolated);
  for (const SweepKey& key : graph.nodes) {
    const auto at = std::lower_bound(made.graph.nodes.begin(), made.graph.nodes.end(), key);
    graph.positions.push_back(made.graph.positions[static_cast<std::size_t>(at - made.graph.nodes.begin())]);
  }
  return graph;
}

}  // namespace reeb
