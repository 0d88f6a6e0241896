// The embedding as the content of a Canceller: it yields the buckets of every arc record.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/bucket_lists.h"
#include "libreeb/hierarchy/canceller.h"

namespace reeb {

// A node that is contracted enters a bucket of the arc that contains it then.
//
// MEMORY: ArcBucketLists. The lists that a step changes are open until the step ends.
class BucketVersions {
 public:
  static constexpr bool kFollows = true;
  // One in a hundred extrema of a scan, and one in six of a random function, have a longer path.
  static constexpr std::uint32_t kMostArcsOfExtremum = 8;

  // REQUIRES: `graph` and `sink` outlive this; `lists` are those of the graph's arcs, of this exponent.
  BucketVersions(const ReebGraph& graph, PackedLists lists, int exponent, RecordSink& sink)
      : graph_(graph), sink_(sink), lists_(std::move(lists), exponent) {}

  // The content of the Canceller.
  bool cut(const ArcCut& arc);
  double first_value(const ArcPart& part);
  bool is_reached(double first, Direction d, NodeId node) const {
    return d == kUp ? value(node) >= first : value(node) <= first;
  }
  bool merge(ArcId from, ArcId into) { return !lists_.empty(from) && lists_.merge(from, into); }
  void join(ArcId upper, ArcId lower, NodeId node);
  void lay(ArcId arc, ArcId other, NodeId extremum, Direction /*direction*/) { join(arc, other, extremum); }
  void drop(ArcId arc, std::uint32_t nodes);
  std::span<const std::byte> before_step(ArcId arc) const { return lists_.closed(arc); }
  void commit();
  void prefetch_node(NodeId node) const {
    __builtin_prefetch(&graph_.nodes[node.value()]);
    if (!graph_.positions.empty()) __builtin_prefetch(&graph_.positions[node.value()]);
  }
  void prefetch_place(ArcId arc) const { lists_.prefetch_place(arc); }
  void prefetch(ArcId arc) const { lists_.prefetch(arc); }

 private:
  double value(NodeId node) const { return graph_.nodes[node.value()].value; }

  const ReebGraph& graph_;
  RecordSink& sink_;
  ArcBucketLists lists_;
  std::uint32_t step_ = 1;
};

}  // namespace reeb
