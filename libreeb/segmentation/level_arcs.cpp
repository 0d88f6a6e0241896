#include "libreeb/segmentation/level_arcs.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <vector>

#include "libreeb/hierarchy/canceller.h"
#include "libreeb/hierarchy/pairing.h"
#include "libreeb/hierarchy/subgraph.h"

namespace reeb {
namespace {

// The content of a Canceller: writes what happens to arcs to a log.
class LoggedArcs {
 public:
  static constexpr bool kFollows = true;
  static constexpr std::uint32_t kMostArcsOfExtremum = kAnyNumberOfArcs;

  LoggedArcs(const ReebGraph& graph, ArcLog& log) : graph_(graph), log_(log) {}

  bool cut(const ArcCut& arc) {
    log_.cut(arc.from.value(), arc.into.value(), key(arc.node), opposite(arc.direction));
    return false;
  }
  // Any part of an arc can have vertices.
  double first_value(const ArcPart& /*part*/) { return 0; }
  bool is_reached(double /*value*/, Direction /*along*/, NodeId /*node*/) const { return true; }
  bool merge(ArcId from, ArcId into) {
    log_.merge(from.value(), into.value());
    return false;
  }
  void join(ArcId upper, ArcId lower, NodeId node) { log_.join(upper.value(), lower.value(), key(node), kUp); }
  void lay(ArcId arc, ArcId other, NodeId extremum, Direction d) {
    log_.lay(arc.value(), other.value(), key(extremum), opposite(d));
  }
  void drop(ArcId arc, std::uint32_t /*nodes*/) { log_.drop(arc.value()); }
  std::span<const std::byte> before_step(ArcId /*arc*/) const { return {}; }
  void commit() {}
  void prefetch_node(NodeId /*node*/) const {}
  void prefetch_place(ArcId /*arc*/) const {}
  void prefetch(ArcId /*arc*/) const {}

 private:
  const SweepKey& key(NodeId node) const { return graph_.nodes[node.value()]; }

  const ReebGraph& graph_;
  ArcLog& log_;
};

class NoRecords : public RecordSink {
 public:
  void add(const ArcVersion& /*record*/, std::span<const std::byte> /*buckets*/) override {}
};

// The present graph, whose arcs are settled in its order. `isolated` are the nodes without arcs that stay.
ReebGraph settle_all(const ReebGraph& full, const WorkingGraph& present, const std::vector<NodeId>& isolated,
                     ArcLog& log) {
  std::vector<ArcId> arcs;
  for (ArcId arc; arc < present.end_arc(); ++arc)
    if (present.alive(arc)) arcs.push_back(arc);
  const auto ends = [&](ArcId arc) { return std::tuple(present.end(arc, kDown), present.end(arc, kUp), arc); };
  std::sort(arcs.begin(), arcs.end(), [&](ArcId a, ArcId b) { return ends(a) < ends(b); });

  constexpr NodeId kGone = NodeId::none();
  std::vector<NodeId> rank(full.node_count(), kGone);
  for (const NodeId node : isolated) rank[node.value()] = NodeId(0);
  for (const ArcId arc : arcs)
    for (const Direction d : {kDown, kUp}) rank[present.end(arc, d).value()] = NodeId(0);
  ReebGraph graph;
  for (std::size_t n = 0; n < rank.size(); ++n) {
    if (rank[n] == kGone) continue;
    rank[n] = NodeId(static_cast<std::uint32_t>(graph.node_count()));
    graph.nodes.push_back(full.nodes[n]);
  }
  for (const ArcId arc : arcs) {
    graph.lo.push_back(rank[present.end(arc, kDown).value()]);
    graph.hi.push_back(rank[present.end(arc, kUp).value()]);
    log.settle(arc.value());
  }
  return graph;
}

}  // namespace

ReebGraph cancel_to_version(const ReebGraph& graph, std::uint32_t version, ArcLog& log, const Poll& poll) {
  constexpr std::size_t kPairsBetweenPolls = 1024;
  const std::vector<PersistencePair> pairs = persistence_pairs(graph, poll);
  NoRecords records;
  Canceller canceller(WorkingGraph(graph), records, LoggedArcs(graph, log));
  for (std::size_t i = 0, done = 0; done < version && i < pairs.size(); ++i) {
    if (poll && i % kPairsBetweenPolls == 0) poll(static_cast<double>(done) / version);
    if (canceller.cancel(pairs[i])) ++done;
  }
  return settle_all(graph, canceller.graph(), isolated_nodes(graph), log);
}

}  // namespace reeb
