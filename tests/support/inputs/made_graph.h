// Large Reeb graphs of several kinds. A generator sweeps over a row of contours, which start, split, merge with a
// neighbour, and end.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "libreeb/containers/union_find.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb::bench {

// Perforated plate: one row of strips, every hole a loop. Noise: starts and ends, most of them soon.
// Expander: any two contours of the row merge. All are connected.
enum GraphKind { kPlate, kNoise, kExpander };

class GraphMaker {
 public:
  GraphMaker(GraphKind kind, std::size_t arcs) : kind_(kind), arcs_wanted_(arcs) {}

  ReebGraph make() {
    start(0);
    while (arcs_.size() + row_.size() < arcs_wanted_) event();
    while (row_.size() > 1) merge(0, 1);
    end(0);
    return make_graph(std::move(arcs_), {});
  }

 private:
  static constexpr std::size_t kWidth = 1000;
  struct Contour {
    SweepKey below;  // the lower node of its arc
    std::uint32_t component;
  };

  SweepKey next_key() {
    value_ += static_cast<double>(random_() % 1000) / 1000;
    return {value_, VertexId(vertex_++)};
  }
  std::size_t any() { return random_() % row_.size(); }
  auto place(std::size_t i) { return row_.begin() + static_cast<std::ptrdiff_t>(i); }

  void start(std::size_t i) {
    row_.insert(place(i), {next_key(), components_.add()});
    open_.push_back(1);
  }
  void end(std::size_t i) {
    arcs_.push_back({row_[i].below, next_key()});
    --open_[components_.find(row_[i].component)];
    row_.erase(place(i));
  }
  bool may_end(std::size_t i) { return open_[components_.find(row_[i].component)] > 1; }
  void split(std::size_t i) {
    arcs_.push_back({row_[i].below, next_key()});
    row_[i].below = arcs_.back().hi;
    row_.insert(place(i), Contour(row_[i]));
    ++open_[components_.find(row_[i].component)];
  }
  void merge(std::size_t i, std::size_t j) {
    const SweepKey key = next_key();
    arcs_.push_back({row_[i].below, key});
    arcs_.push_back({row_[j].below, key});
    const std::uint32_t a = components_.find(row_[i].component), b = components_.find(row_[j].component);
    const std::uint32_t both = a == b ? open_[a] : open_[a] + open_[b];
    components_.unite(a, b);
    open_[components_.find(a)] = both - 1;
    row_[i].below = key;
    row_.erase(place(j));
  }

  void event() {
    const bool grow = random_() % (2 * kWidth) >= row_.size();
    const std::size_t i = any();
    if (kind_ == kNoise && random_() % 2 == 0) {
      if (grow)
        start(i);
      else if (may_end(i))
        end(i);
    } else if (grow || row_.size() == 1) {
      split(i);
      // A split is followed by an end or a merge at once, so that small features are the most frequent.
      if (kind_ == kNoise && random_() % 4 != 0) {
        if (random_() % 2 == 0)
          end(i);
        else
          merge(i, i + 1);
      }
    } else {
      const std::size_t j = kind_ == kExpander ? any() : (i + 1) % row_.size();
      if (i != j) merge(i, j);
    }
  }

  const GraphKind kind_;
  const std::size_t arcs_wanted_;
  std::mt19937_64 random_{1};
  double value_ = 0;
  std::uint64_t vertex_ = 0;
  std::vector<Contour> row_;
  UnionFind components_{0};
  std::vector<std::uint32_t> open_;  // contours of each component, by its representative
  std::vector<ArcKeys> arcs_;
};

// Gives the nodes positions, in rows.
inline void place_nodes(ReebGraph& graph) {
  for (std::size_t node = 0; node < graph.node_count(); ++node)
    graph.positions.push_back({static_cast<double>(node % 400), static_cast<double>(node / 400), 0});
}

// An embedding of the graph in which an arc has a vertex in every bucket that it crosses.
inline ArcBuckets make_buckets(const ReebGraph& graph, int exponent) {
  ArcBuckets buckets{.offsets = {0}, .buckets = {}};
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const std::int64_t first = bucket_index(graph.nodes[graph.lo[arc].value()].value, exponent);
    const std::int64_t last = bucket_index(graph.nodes[graph.hi[arc].value()].value, exponent);
    for (std::int64_t i = first; i <= last; ++i)
      buckets.buckets.push_back({i, 1, {static_cast<double>(i), static_cast<double>(arc % 1000), 0}});
    buckets.offsets.push_back(buckets.buckets.size());
  }
  return buckets;
}

}  // namespace reeb::bench
