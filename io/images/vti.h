// VTK XML image data (.vti): values of points as text, in base64, or after the document; packed with zlib or LZ4 or
// not; in one piece. The active scalars, else the first array of points, are read. Vertex (0, 0, 0) is the first point
// of the extent.
#pragma once

#include "io/images/image.h"

namespace reeb::io {

// Whether it is a VTK XML file of image data.
bool is_vti(std::string_view head);

// Reads the document up to its first value. Image::from_start is set if the content is needed from its beginning and
// views beyond the first were taken.
// THROWS: Error{kBadInput} with line and column.
Image parse_vti(ContentSource& source);

}  // namespace reeb::io
