// Collects settled nodes and arcs for a sink, which takes many at once.
#pragma once

#include <cstddef>
#include <vector>

#include "libreeb/graph/bucket_sums.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

class SettledBatch {
 public:
  std::size_t size() const { return nodes_.size() + arcs_.size(); }
  void add_node(const SettledNode& node) { nodes_.push_back(node); }
  void add_arc(const ArcKeys& arc) { arcs_.push_back(arc); }
  // The embedding of the arc that was added last. Leaves the list empty.
  void add_buckets(BucketLists& buckets, BucketLists::List& list) { buckets.drain_means(list, lists_); }

  // Passes all of them on to the sink, and keeps the memory.
  void flush(GraphSink& sink, int bucket_exponent) {
    if (!nodes_.empty()) sink.add_nodes(nodes_);
    if (!arcs_.empty()) sink.add_arcs({arcs_, lists_.view(), bucket_exponent});
    nodes_.clear();
    arcs_.clear();
    lists_.clear();
  }

  std::size_t memory_bytes() const {
    return nodes_.capacity() * sizeof(SettledNode) + arcs_.capacity() * sizeof(ArcKeys) + lists_.memory_bytes();
  }

 private:
  std::vector<SettledNode> nodes_;
  std::vector<ArcKeys> arcs_;
  ArcLists lists_;  // one per arc, if there is an embedding
};

}  // namespace reeb
