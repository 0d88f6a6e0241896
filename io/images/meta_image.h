// MetaImage: a text header (.mhd, .mha), then the data, in the same file or another.
#pragma once

#include "io/images/image.h"

namespace reeb::io {

bool is_meta_image(std::string_view head);

// THROWS: Error{kBadInput} with line and column.
Image parse_meta_image(ContentSource& source);

}  // namespace reeb::io
