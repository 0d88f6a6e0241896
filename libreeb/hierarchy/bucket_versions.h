// The embedding of every arc record of a hierarchy: the content that the Canceller carries along.
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/bucket_lists.h"
#include "libreeb/hierarchy/canceller.h"

namespace reeb {

// Keeps what each arc had when its record ended. A node that disappears enters a bucket of the arc
// that it becomes part of.
//
// MEMORY: 8 bytes an arc and 48 a bucket of the present version; 8 bytes a record and 40 a bucket
//         of the records that ended.
class BucketVersions {
 public:
  static constexpr bool kFollows = true;

  // `graph` must outlive this. REQUIRES: `buckets` has those of its arcs.
  BucketVersions(const ReebGraph& graph, ArcBuckets buckets, int exponent)
      : graph_(graph), lists_(std::move(buckets), graph.arc_count(), exponent), saved_(graph.arc_count(), kNone) {}

  // The content of the Canceller.
  bool cut(const ArcCut& arc);
  bool merge(std::uint32_t from, std::uint32_t into);
  void join(std::uint32_t upper, std::uint32_t lower, std::uint32_t node);
  void drop(std::uint32_t arc);

  // The arc's next record ends with this step, or the arc lives on after the last.
  void end_record(std::uint32_t arc);
  void commit();

  // Of all records that ended, in that order.
  ArcBuckets take_buckets() { return std::move(ended_); }
  std::vector<DroppedVertices> take_dropped() { return std::move(dropped_); }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  // What an arc had before this step.
  struct Saved {
    std::uint32_t arc;
    std::size_t begin, end;  // in saved_buckets_
  };
  void save(std::uint32_t arc);
  double value(std::uint32_t node) const { return graph_.nodes[node].value; }

  const ReebGraph& graph_;
  ArcBucketLists lists_;
  std::vector<std::uint32_t> saved_;  // of each arc, its entry in saves_
  std::vector<Saved> saves_;
  std::vector<Bucket> saved_buckets_;
  std::uint32_t step_ = 1;
  ArcBuckets ended_{.offsets = {0}, .buckets = {}};
  std::vector<DroppedVertices> dropped_;
};

}  // namespace reeb
