// The kinds of grid surfaces: which layout each has, and how it lies in space.
#pragma once

#include <memory>

#include "io/generate/shape.h"

namespace reeb::io {

// REQUIRES: options.kind is not kSierpinski. THROWS: Error{kUsage} for a width it cannot have.
std::unique_ptr<Shape> make_grid_surface(const GeneratorOptions& options);

}  // namespace reeb::io
