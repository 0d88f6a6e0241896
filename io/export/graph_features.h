// What exports say of nodes and arcs besides the graph itself (docs/CLI.md, `reeb extract FILE`).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::io {

// The type of a point, with the numbers of TTK.
enum class CriticalType : std::uint8_t {
  kMinimum = 0,  // nothing below it; isolated points, too
  kJoin = 1,     // several arcs down, one up
  kSplit = 2,    // one arc down, several up
  kMaximum = 3,  // nothing above it
  kBoth = 4,     // several arcs down and up
  kRegular = 5,  // between nodes
};
CriticalType critical_type(std::uint32_t down, std::uint32_t up);

// Pairs and loops are those of this very graph, which at a coarse level are those that were not cancelled.
struct GraphFeatures {
  Degrees degree;
  // Of each node. Components are numbered by their lowest nodes, from 0.
  std::vector<std::uint32_t> component;
  std::vector<double> persistence;  // the largest of the node's pairs
  // Of each arc: the persistence of the smallest loop that it is on, or kNoLoop (loop_ranges.h).
  std::vector<double> loop;

  CriticalType type(std::size_t node) const { return critical_type(degree.down[node], degree.up[node]); }
};

// TIME:   O((nodes + arcs) log(nodes)).
// MEMORY: 20 bytes per node and 8 per arc; during the call up to 100 for each.
GraphFeatures find_features(const ReebGraph& graph);

}  // namespace reeb::io
