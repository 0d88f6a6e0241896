// From a mesh to the fragments of one of its shares, within a memory budget.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/port/vertex_function.h"
#include "ooc/distributed/part_info.h"
#include "ooc/run/compute.h"
#include "ooc/run/compute_result.h"

namespace reeb::ooc {

struct PartChoice {
  std::uint32_t part = 0, parts = 1;  // from 0
  std::vector<std::string> shared;    // files of names of all parts; empty: the mesh is read
};

struct FragmentResult {
  PartInfo info;
  std::string output;
  std::uint64_t open_vertices = 0;
  PhaseSeconds seconds;
  std::vector<std::string> notes;
};

// Computes the share for functions[i] and writes its fragment to outputs[i].
// THROWS: as compute(); Error{kBadInput} of a file of names.
std::vector<FragmentResult> compute_part(MeshInput input, std::span<VertexFunction* const> functions,
                                         std::span<const std::string> outputs, const ComputeOptions& options,
                                         const PartChoice& choice);

// Writes which vertices the share names, and returns how many there are.
std::uint64_t scan_part(MeshInput input, std::span<VertexFunction* const> functions, const std::string& output,
                        const ComputeOptions& options, const PartChoice& choice);

}  // namespace reeb::ooc
