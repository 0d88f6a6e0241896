// NRRD: a text header, then the data, in the same file or another (http://teem.sourceforge.net/nrrd/format.html).
//
// Two or three axes, and before them one of components (its kind is not a domain, or its direction is none); axes of
// size 1 after the third are left out. The position of a vertex is that of `space directions` and `space origin`, else
// of `spacings` and `axis mins`; `centers: cell` moves the latter by half a step.
#pragma once

#include "io/images/image.h"

namespace reeb::io {

bool is_nrrd(std::string_view head);

// THROWS: Error{kBadInput} with line and column.
Image parse_nrrd(ContentSource& source);

}  // namespace reeb::io
