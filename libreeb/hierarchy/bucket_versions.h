// The embedding as the content of a Canceller: it yields the buckets of every arc record.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "libreeb/base/prefetch.h"
#include "libreeb/graph/bucket_lists.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/graph/remaining_buckets.h"
#include "libreeb/graph/tables_in_memory.h"
#include "libreeb/hierarchy/arc_changes.h"

namespace reeb {

// What buckets need to know of the nodes of a graph.
class NodesInMemory {
 public:
  // REQUIRES: `graph` outlives this.
  explicit NodesInMemory(const ReebGraph& graph) : graph_(graph) {}
  double value(NodeId node) const { return graph_.nodes[node.value()].value; }
  std::array<double, 3> position(NodeId node) const {
    return graph_.positions.empty() ? std::array<double, 3>{} : graph_.positions[node.value()];
  }
  void prefetch_value(NodeId node) const { reeb::prefetch(&graph_.nodes[node.value()]); }
  void prefetch(NodeId node) const {
    prefetch_value(node);
    if (!graph_.positions.empty()) reeb::prefetch(&graph_.positions[node.value()]);
  }

 private:
  const ReebGraph& graph_;
};

// A node that is contracted enters a bucket of the arc that contains it then.
//
// MEMORY: ArcBucketLists. The lists that a step changes are open until the step ends.
template <class Nodes = NodesInMemory, class Lists = PackedLists>
class BucketVersions {
 public:
  static constexpr bool kFollows = true;
  // One in a hundred extrema of a scan, and one in six of a random function, have a longer path.
  static constexpr std::uint32_t kMostArcsOfExtremum = 8;

  // REQUIRES: what `nodes` refers to and `sink` outlive this; `lists` are those of the graph's arcs, of this exponent.
  BucketVersions(Nodes nodes, Lists lists, int exponent, RecordSink& sink)
      : nodes_(std::move(nodes)), sink_(sink), lists_(std::move(lists), exponent) {}

  // The content of the Canceller.
  bool cut(const ArcCut& arc);
  double first_value(const ArcPart& part);
  bool is_reached(double first, Direction d, NodeId node) const {
    if (first == kNever || first == -kNever) return false;  // without a look at the node
    return d == kUp ? value(node) >= first : value(node) <= first;
  }
  // first_value() for the thread of the rules, which must not look at open lists. start_rest() copies the content
  // before this step. A later call first cuts the copy at the start of the part.
  struct Rest {
    RemainingBuckets buckets;
    NodeId start;
  };
  void start_rest(const ArcPart& part, Rest& rest) const;
  double first_value(const ArcPart& part, Rest& rest) const;
  bool merge(ArcId from, ArcId into) { return lists_.merge(from, into); }
  void join(ArcId upper, ArcId lower, NodeId node);
  void lay(ArcId arc, ArcId other, NodeId extremum, Direction /*direction*/) { join(arc, other, extremum); }
  void drop(ArcId arc, std::uint32_t nodes);
  std::span<const std::byte> before_step(ArcId arc) const { return lists_.closed(arc); }
  void commit();
  void prefetch_node(NodeId node) const { nodes_.prefetch(node); }
  void prefetch_value(NodeId node) const { nodes_.prefetch_value(node); }
  void prefetch_place(ArcId arc) const { lists_.prefetch_place(arc); }
  void prefetch(ArcId arc) const { lists_.prefetch(arc); }

  const BasicArcBucketLists<Lists>& lists() const { return lists_; }
  // As PackedLists: hold for this many changes, at most two lists each.
  void hold(std::size_t changes) { lists_.hold(2 * changes); }
  void release() { lists_.release(); }
  bool holds_much() const { return lists_.packed().holds_much(); }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static double never(Direction d) { return d == kUp ? kNever : -kNever; }

  double value(NodeId node) const { return nodes_.value(node); }

  Nodes nodes_;
  RecordSink& sink_;
  BasicArcBucketLists<Lists> lists_;
  std::uint32_t step_ = 1;
};

template <class Nodes, class Lists>
bool BucketVersions<Nodes, Lists>::cut(const ArcCut& arc) {
  if (lists_.empty(arc.from)) return false;
  const auto [lo, hi] = std::minmax(arc.start, arc.end);
  return lists_.cut(opposite(arc.direction), arc.from, arc.into, {value(lo), value(arc.node), value(hi)});
}

template <class Nodes, class Lists>
double BucketVersions<Nodes, Lists>::first_value(const ArcPart& part) {
  if (lists_.empty(part.arc)) return never(part.direction);
  const auto [lo, hi] = std::minmax(part.start, part.end);
  return lists_.first_value(part.direction, part.arc, value(lo), value(hi));
}

template <class Nodes, class Lists>
void BucketVersions<Nodes, Lists>::start_rest(const ArcPart& part, Rest& rest) const {
  rest.start = part.start;
  rest.buckets.start(part.direction, value(part.start), value(part.end), before_step(part.arc), lists_.exponent());
}

template <class Nodes, class Lists>
double BucketVersions<Nodes, Lists>::first_value(const ArcPart& part, Rest& rest) const {
  if (rest.start != part.start) rest.buckets.cut(value(part.start));
  rest.start = part.start;
  return rest.buckets.empty() ? never(part.direction) : rest.buckets.first_value();
}

template <class Nodes, class Lists>
void BucketVersions<Nodes, Lists>::join(ArcId upper, ArcId lower, NodeId node) {
  lists_.merge(upper, lower);
  lists_.add(lower, value(node), nodes_.position(node));
}

template <class Nodes, class Lists>
void BucketVersions<Nodes, Lists>::drop(ArcId arc, std::uint32_t nodes) {
  if (const std::uint64_t count = lists_.drop(arc) + nodes; count != 0) sink_.drop({step_, count});
}

template <class Nodes, class Lists>
void BucketVersions<Nodes, Lists>::commit() {
  lists_.close();
  ++step_;
}

}  // namespace reeb
