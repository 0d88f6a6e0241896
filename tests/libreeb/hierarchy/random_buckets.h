// Random embeddings of random graphs, in which the first coordinate of a vertex is its value.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>

#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/bucket.h"
#include "tests/libreeb/hierarchy/random_graphs.h"

namespace reeb::test {

struct EmbeddedGraph {
  ReebGraph graph;
  ArcBuckets buckets;
  int exponent = 0;
};

inline Bucket bucket_of_points(std::int64_t index, const std::vector<std::array<double, 3>>& points) {
  Bucket bucket{index, points.size(), {}};
  for (const auto& point : points)
    for (std::size_t axis = 0; axis < 3; ++axis) bucket.mean[axis] += point[axis] / static_cast<double>(points.size());
  return bucket;
}

// Half of the arcs have up to 11 vertices, anywhere between their ends.
inline EmbeddedGraph random_embedded_graph(Random& random, std::uint32_t max_nodes) {
  EmbeddedGraph made{
      random_graph(random, max_nodes), {.offsets = {0}, .buckets = {}}, static_cast<int>(below(random, 7)) - 3};
  const auto point = [&](double value) {
    return std::array<double, 3>{value, static_cast<double>(below(random, 100)), -value};
  };
  for (const SweepKey& node : made.graph.nodes) made.graph.positions.push_back(point(node.value));
  for (std::size_t arc = 0; arc < made.graph.arc_count(); ++arc) {
    const double lo = made.graph.nodes[made.graph.lo[arc].value()].value;
    const double hi = made.graph.nodes[made.graph.hi[arc].value()].value;
    std::map<std::int64_t, std::vector<std::array<double, 3>>> points;
    for (std::uint32_t i = below(random, 2) * below(random, 12); i > 0; --i) {
      const double value = lo + (hi - lo) * below(random, 1025) / 1024;
      points[bucket_index(value, made.exponent)].push_back(point(value));
    }
    for (const auto& [index, own] : points) made.buckets.buckets.push_back(bucket_of_points(index, own));
    made.buckets.offsets.push_back(made.buckets.buckets.size());
  }
  return made;
}

// The number of vertices and the sum of their positions, which moving them between arcs must not change.
struct Mass {
  std::uint64_t count = 0;
  std::array<double, 3> sum{};

  void add(std::uint64_t vertices, const std::array<double, 3>& mean) {
    count += vertices;
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += mean[axis] * static_cast<double>(vertices);
  }
  void add(std::span<const Bucket> buckets) {
    for (const Bucket& bucket : buckets) add(bucket.count, bucket.mean);
  }
};

inline Mass mass_of_nodes(const ReebGraph& graph) {
  Mass mass;
  for (const auto& position : graph.positions) mass.add(1, position);
  return mass;
}

inline Mass mass_of(const ReebGraph& graph, const ArcBucketsView& buckets) {
  Mass mass = mass_of_nodes(graph);
  mass.add(buckets.buckets);
  return mass;
}

// Whether the buckets of an arc ascend, are not empty, are within its values, and have means within their own values.
inline bool well_formed(std::span<const Bucket> own, double lo, double hi, int exponent) {
  constexpr double kRounding = 1e-9;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const auto index = static_cast<double>(own[i].index);
    if (own[i].count == 0 || (i > 0 && own[i].index <= own[i - 1].index)) return false;
    if (own[i].index < bucket_index(lo, exponent) || own[i].index > bucket_index(hi, exponent)) return false;
    if (own[i].mean[0] < std::ldexp(index, exponent) - kRounding ||
        own[i].mean[0] > std::ldexp(index + 1, exponent) + kRounding)
      return false;
  }
  return true;
}

}  // namespace reeb::test
