#include "io/export/graph_features.h"

#include <algorithm>

#include "libreeb/containers/union_find.h"
#include "libreeb/graph/loop_ranges.h"
#include "libreeb/hierarchy/pairing.h"

namespace reeb::io {
namespace {

std::vector<std::uint32_t> components(const ReebGraph& graph) {
  UnionFind sets(static_cast<std::uint32_t>(graph.node_count()));
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) sets.unite(graph.lo[arc].value(), graph.hi[arc].value());
  std::vector<std::uint32_t> numbers(graph.node_count());
  std::uint32_t next = 0;
  for (std::uint32_t node = 0; node < numbers.size(); ++node) {
    const std::uint32_t lowest = sets.find(node);
    numbers[node] = lowest == node ? next++ : numbers[lowest];
  }
  return numbers;
}

std::vector<double> persistences(const ReebGraph& graph) {
  std::vector<double> largest(graph.node_count());
  for (const PersistencePair& pair : persistence_pairs(graph))
    for (const NodeId node : {pair.lo, pair.hi})
      largest[node.value()] = std::max(largest[node.value()], persistence_of(graph, pair));
  return largest;
}

}  // namespace

CriticalType critical_type(std::uint32_t down, std::uint32_t up) {
  if (down == 0) return CriticalType::kMinimum;
  if (up == 0) return CriticalType::kMaximum;
  if (down > 1 && up > 1) return CriticalType::kBoth;
  if (down > 1) return CriticalType::kJoin;
  return up > 1 ? CriticalType::kSplit : CriticalType::kRegular;
}

GraphFeatures find_features(const ReebGraph& graph) {
  return {degrees(graph), components(graph), persistences(graph), loop_ranges(graph)};
}

}  // namespace reeb::io
