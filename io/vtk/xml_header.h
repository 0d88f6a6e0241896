// An index of an XML file of VTK (.vtu, .vtp): where its arrays are.
#pragma once

#include "io/vtk/grid_file.h"

namespace reeb::io {

// Reads through the file up to its appended data.
// THROWS: Error{kBadInput} with place and hint.
GridFile read_xml_header(const ContentSource& content);

}  // namespace reeb::io
