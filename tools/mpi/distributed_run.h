// A run of all ranks: each computes its share, neighbours are glued in a tree, and the root writes the files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/library/compute.h"
#include "tools/mpi/world.h"

namespace reeb::tools {

struct DistributedResult {
  std::vector<ComputeResult> results;  // at the root: by function
  double share_seconds = 0, tree_seconds = 0;
  std::uint64_t names_bytes = 0;  // that this rank sent
  std::uint64_t tree_bytes = 0;
};

// As compute(); all ranks call it with the same arguments. What settles in a rank goes to files next to the output,
// OUT.rank-K-..., which are removed in the end.
DistributedResult compute_distributed(World& world, const std::string& path, std::span<const std::string> functions,
                                      std::span<const std::string> outputs, const ComputeOptions& options);

}  // namespace reeb::tools
