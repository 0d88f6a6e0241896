// Options of the commands that read a mesh, for images.
#pragma once

#include <CLI/CLI.hpp>

#include "io/formats/open_mesh.h"

namespace reeb::tools {

// `image` must outlive the parsing.
void add_image_options(CLI::App& command, io::ImageOptions& image);

}  // namespace reeb::tools
