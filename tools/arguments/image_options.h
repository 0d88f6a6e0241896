// Options of the commands that read a mesh, for images.
#pragma once

#include "io/formats/open_mesh.h"
#include "tools/arguments/arguments.h"

namespace reeb::tools {

// `image` must outlive the parsing.
void add_image_options(Command command, io::ImageOptions& image);

// For a command that was given no mesh. THROWS: Error{kUsage} if one of these options was given.
void refuse_image_options(const io::ImageOptions& image);

}  // namespace reeb::tools
