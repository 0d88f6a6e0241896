// Collects settled nodes and arcs for a sink, which takes many at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/graph/bucket.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

class SettledBatch {
 public:
  std::size_t size() const { return nodes_.size() + arcs_.size(); }
  void add_node(const SettledNode& node) { nodes_.push_back(node); }
  void add_arc(const ArcKeys& arc) { arcs_.push_back(arc); }
  // The embedding of the arc that was added last: calls list_buckets(add) once, which calls add(bucket) for each.
  template <class ListBuckets>
  void add_buckets(const ListBuckets& list_buckets) {
    const std::size_t before = buckets_.size();
    list_buckets([this](const Bucket& bucket) { buckets_.push_back(bucket); });
    bucket_counts_.push_back(static_cast<std::uint32_t>(buckets_.size() - before));
  }

  // Passes all of them on to the sink, and keeps the memory.
  void flush(GraphSink& sink, int bucket_exponent) {
    if (!nodes_.empty()) sink.add_nodes(nodes_);
    if (!arcs_.empty()) sink.add_arcs({arcs_, bucket_counts_, buckets_, bucket_exponent});
    nodes_.clear();
    arcs_.clear();
    bucket_counts_.clear();
    buckets_.clear();
  }

  std::size_t memory_bytes() const {
    return nodes_.capacity() * sizeof(SettledNode) + arcs_.capacity() * sizeof(ArcKeys) +
           4 * bucket_counts_.capacity() + buckets_.capacity() * sizeof(Bucket);
  }

 private:
  std::vector<SettledNode> nodes_;
  std::vector<ArcKeys> arcs_;
  std::vector<std::uint32_t> bucket_counts_;  // one per arc, if there is an embedding
  std::vector<Bucket> buckets_;
};

}  // namespace reeb
