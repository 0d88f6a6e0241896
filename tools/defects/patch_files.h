// The surface around defects, as files to look at.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "tools/defects/defect_text.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

// For each row two files in `folder`, which is created if it is missing: defect-RANK.ply, the surface around the curve,
// coloured by the row's function from blue to red, and defect-RANK-curves.ply, the curves as edges: the shorter one
// red, the other one green. Of a row without curves, the surface around both vertices. Reads the mesh once. THROWS:
// Error{kBadInput} for files that exist, unless they may be replaced; Error{kResource} if the folder cannot be written.
void write_patches(const ValuedMesh& mesh, const Defects& defects, std::span<const RankedRow> rows,
                   const std::string& folder, io::Existing existing);

// The names of these files.
std::vector<std::string> patch_names(std::span<const RankedRow> rows, const std::string& folder);

}  // namespace reeb::tools
