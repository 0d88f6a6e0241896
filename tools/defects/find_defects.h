// From a mesh to the table of its defects: what `reeb defects` does.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tools/defects/defect_rows.h"
#include "tools/library/compute.h"

namespace reeb::tools {

struct FindDefectsOptions {
  MeshSource mesh;
  std::vector<std::string> files;      // graphs of the mesh; none: those of these functions are computed
  std::vector<std::string> functions;  // none: its coordinates
  std::set<LoopName> named;            // loops that have a row in any case
  unsigned threads = 0;
  std::function<void(const ComputeProgress&)> computing{};
  std::function<void(std::uint64_t done, std::uint64_t total, std::uint64_t triangles)> searching{};
};

struct Defects {
  std::vector<std::string> functions;  // of the rows
  DefectTable table;
  PatchScale scale;
  std::string note;  // what is odd about the mesh, if anything is
};

// THROWS: as compute(); Error{kBadInput} for a graph of another mesh, and for a mesh with cells.
// MEMORY: that of computing the graphs; then of one graph and its pairs; then of patches.
Defects find_defects(const FindDefectsOptions& options);

}  // namespace reeb::tools
