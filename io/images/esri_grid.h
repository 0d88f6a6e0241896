// ESRI ASCII grids (.asc): a few lines of header, then rows of heights from north to south. A vertex is the centre of a
// cell, so y falls with the rows.
#pragma once

#include "io/images/image.h"

namespace reeb::io {

// Whether the first word is one of a header.
bool is_esri_grid(std::string_view head);

// THROWS: Error{kBadInput} with line and column.
Image parse_esri_grid(ContentSource& source);

}  // namespace reeb::io
