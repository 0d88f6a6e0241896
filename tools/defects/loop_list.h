// The loops of Reeb graphs, with the places of their nodes.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/sweep_key.h"
#include "libreeb/base/value_range.h"
#include "libreeb/format/mesh_match.h"
#include "libreeb/graph/settled_node.h"

namespace reeb::tools {

struct Loop {
  std::size_t function = 0;
  SettledNode lo, hi;
  std::uint32_t component = 0;                // of its function
  bool lo_divides = false, hi_joins = false;  // exactly two arcs lead up from lo, and down from hi
};

// A loop by its nodes and its function.
struct LoopName {
  std::uint64_t lo = 0, hi = 0;
  std::string function;
  auto operator<=>(const LoopName&) const = default;
};

struct LoopFunction {
  std::string file, name;
  ValueRange range;
  MeshCounts mesh;
  std::vector<SettledNode> tops;  // the highest node of each component
};

struct LoopList {
  std::vector<LoopFunction> functions;
  std::vector<Loop> loops;     // by function
  std::array<Point, 2> box{};  // of all nodes
};

LoopName name_of(const LoopList& list, const Loop& loop);

// From `.reeb` files of one mesh, also without levels.
// THROWS: Error{kBadInput} of a file, and if they are of different meshes.
// MEMORY: that of one graph, and of its pairs.
LoopList read_loops(std::span<const std::string> files);

}  // namespace reeb::tools
