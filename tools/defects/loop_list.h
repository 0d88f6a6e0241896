// The loops of Reeb graphs, with the places of their nodes.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/base/value_range.h"
#include "libreeb/format/mesh_match.h"
#include "libreeb/graph/settled_node.h"

namespace reeb::tools {

struct Loop {
  std::size_t function = 0;
  SettledNode lo, hi;
  std::uint32_t component = 0;                // of those of its function that have loops
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
  std::uint64_t components = 0;  // also those without loops
  std::uint64_t arcs = 0;
  std::vector<SettledNode> tops;  // the highest node of each component that has loops
};

struct LoopList {
  std::vector<LoopFunction> functions;
  std::vector<Loop> loops;     // by function
  std::array<Point, 2> box{};  // of all nodes
  Reservation memory;          // of loops and tops
};

LoopName name_of(const LoopList& list, const Loop& loop);

// From `.reeb` files of one mesh, also without levels.
// THROWS: Error{kBadInput} of a file, and if they are of different meshes.
//         Error{kResource} of the budget, which must outlive the list.
// MEMORY: that of one graph, and of its pairs; reserved.
LoopList read_loops(std::span<const std::string> files, MemoryBudget& budget);

}  // namespace reeb::tools
