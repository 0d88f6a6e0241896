// From a mesh in a file to the fragments of one of its parts, and from fragments to a graph: what the programs
// `reeb fragment` and `reeb glue` do.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ooc/distributed/compute_part.h"
#include "tools/library/compute.h"

namespace reeb {

// THROWS: as compute(); Error{kUsage} for a mesh from standard input, of which no part can be computed apart.
std::vector<ooc::FragmentResult> compute_fragments(const std::string& path, std::span<const std::string> functions,
                                                   std::span<const std::string> outputs, const ComputeOptions& options,
                                                   const ooc::PartChoice& choice);

// Writes which vertices the part names, and returns how many there are.
std::uint64_t scan_names(const std::string& path, const std::string& output, const ComputeOptions& options,
                         const ooc::PartChoice& choice);

}  // namespace reeb
