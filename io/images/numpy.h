// NumPy arrays (.npy), versions 1 to 3, with 2 or 3 axes. i is the axis whose values are next to each other in the
// file: the last one in C order, the first one in Fortran order. Vertex (i, j, k) is at that point.
#pragma once

#include "io/images/image.h"

namespace reeb::io {

bool is_numpy(std::string_view head);

// THROWS: Error{kBadInput} with the byte offset.
Image parse_numpy(ContentSource& source);

}  // namespace reeb::io
