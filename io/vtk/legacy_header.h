// An index of a legacy file of VTK: where its arrays are.
#pragma once

#include "io/vtk/grid_file.h"

namespace reeb::io {

// Reads through the file once; over binary arrays it moves without reading.
// THROWS: Error{kBadInput} with place and hint.
GridFile read_legacy_header(const ContentSource& content);

}  // namespace reeb::io
