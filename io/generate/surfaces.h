// The kinds of grid surfaces: the layout of each, and its position in space.
#pragma once

#include <memory>

#include "io/generate/shape.h"

namespace reeb::io {

// REQUIRES: options.kind is neither kSierpinski nor kBall. THROWS: Error{kUsage} for a width that the kind cannot have.
std::unique_ptr<Shape> make_grid_surface(const GeneratorOptions& options);

}  // namespace reeb::io
