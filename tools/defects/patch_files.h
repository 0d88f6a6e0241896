// The surface around defects, as files to look at.
#pragma once

#include <span>
#include <string>

#include "io/file/atomic_file.h"
#include "tools/defects/defect_text.h"
#include "tools/defects/valued_mesh.h"
#include "tools/library/run_files.h"

namespace reeb::tools {

// The patches as outputs: none is a file that is read, or another output. A folder that is missing is an output, too.
void add_patches(const std::string& folder, io::Existing existing, RunFiles& files);

// Checks before any work that patches can be written: the folder is there and can be written, or can be created; no
// patch is in it, unless it may be replaced.
// THROWS: Error{kBadInput} for a patch that exists; Error{kResource} for the folder.
void check_patch_folder(const std::string& folder, io::Existing existing);

// For each row two files in `folder`, which is created if it is missing: defect-RANK.ply, the surface around the curve,
// coloured by the row's function from blue to red, and defect-RANK-curves.ply, the curves as edges: the shorter one
// red, the other one green. Of a row without curves, the surface around both vertices. Reads the mesh once. THROWS: as
// check_patch_folder(); Error{kResource} if the memory does not suffice.
void write_patches(const ValuedMesh& mesh, const Defects& defects, std::span<const RankedRow> rows,
                   const std::string& folder, io::Existing existing);

}  // namespace reeb::tools
