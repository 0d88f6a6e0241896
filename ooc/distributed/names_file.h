// Which vertices a share of a mesh names, in a file (docs/FORMAT.md, Fragments). From those of all shares, each share
// knows what others name without reading the whole mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "ooc/distributed/part_uses.h"
#include "ooc/distributed/whole_mesh.h"
#include "ooc/reeb_writer/frame_writer.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

// Calls visit(first, count) for the runs of consecutive vertices that the share names, ascending. Reads the share once.
void visit_names(RunContext& run, WholeMesh& mesh, std::uint32_t part,
                 const std::function<void(std::uint64_t first, std::uint64_t count)>& visit);

// Whether the file begins as one of names.
bool is_names_file(const std::string& path);

// Writes the names of a share, and returns how many there are.
// THROWS: as AtomicFile and the mesh; Error{kChanged} if the mesh changes meanwhile, and nothing is written.
std::uint64_t write_names(const std::string& path, const OutputOptions& output, RunContext& run, WholeMesh& mesh,
                          std::uint32_t part);

// Merges the names of all shares of a mesh.
// THROWS: Error{kBadInput} that names a file that is damaged or of another mesh, or the share that is missing.
PartUses read_names(std::span<const std::string> files, RunContext& run, const WholeMesh& mesh);

}  // namespace reeb::ooc
