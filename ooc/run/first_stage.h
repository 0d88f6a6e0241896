// The first stage of a run: from a mesh to sorted segments of its Reeb graphs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libreeb/port/simplex_counts.h"
#include "ooc/checkpoints/checkpoint.h"
#include "ooc/run/compute.h"
#include "ooc/run/compute_result.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

// The results that all functions of the run share, and how many pairs were removed for each.
struct FirstStageResult {
  std::uint64_t vertices = 0, unused_vertices = 0;
  std::uint64_t vertex_bound = 0;  // more than the index of any vertex
  SimplexCounts simplices{};       // as listed
  std::uint64_t degenerate_triangles = 0;
  std::uint64_t guessed_vertices = 0, revoked_guesses = 0;
  std::uint64_t spilled_bytes = 0;
  bool reordered = false;
  LiveMaximum live;
  std::vector<std::uint64_t> removed_pairs;  // as noise, by function
  PhaseSeconds seconds;
  std::vector<std::string> notes;
};

// Restores the stores if the run resumes an earlier one, and returns where it goes on; else null. Removes what killed
// writers of its outputs left. THROWS: Error{kBadInput} if an output exists that may not be replaced.
const Checkpoint* start_run(RunContext& run, std::vector<std::string>& notes);

// Fills the stores of the run and the ranges of its values.
// THROWS: Error, of the input, the budget or the disk, or because the run was interrupted; Error{kChanged} if the mesh
//         or a file of values changes meanwhile.
FirstStageResult read_mesh(RunContext& run, MeshInput input);

}  // namespace reeb::ooc
