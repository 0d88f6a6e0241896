// A run of all ranks: each computes its share, neighbours are glued in a tree, and the root writes the files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/library/compute.h"
#include "tools/mpi/world.h"

namespace reeb::tools {

// What a rank did.
struct RankFigures {
  std::uint64_t triangles = 0;              // of its share
  std::uint64_t share_ms = 0, tree_ms = 0;  // on the clock
  std::uint64_t cpu_ms = 0;                 // of processors, all in all
  std::uint64_t names_bytes = 0;            // that it sent
  std::uint64_t tree_bytes = 0;             // that it sent
  std::uint64_t live_vertices = 0;          // at most
  std::uint64_t peak_bytes = 0;             // of memory, as the system counts it
};

struct DistributedResult {
  std::vector<ComputeResult> results;  // at the root: by function
  std::vector<RankFigures> ranks;      // at the root
};

// As compute(); all ranks call it with the same arguments. What settles in a rank goes to files next to the output,
// OUT.rank-K-..., which are removed in the end.
DistributedResult compute_distributed(World& world, const std::string& path, std::span<const std::string> functions,
                                      std::span<const std::string> outputs, const ComputeOptions& options);

}  // namespace reeb::tools
