// Reads the values of an image that a header describes.
#pragma once

#include <memory>

#include "io/file/content_source.h"
#include "io/images/image.h"
#include "libreeb/port/grid_reader.h"

namespace reeb::io {

// `source` is the content of `data`, of which no view beyond the data was taken.
// THROWS: Error{kBadInput} if it is too short for what the header announces.
std::unique_ptr<GridReader> read_image(Image image, Input data, std::unique_ptr<ContentSource> source);

}  // namespace reeb::io
