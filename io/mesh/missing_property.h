// The error about a vertex property that a mesh does not have.
#pragma once

#include <span>
#include <string>

#include "libreeb/base/error.h"

namespace reeb::io {

// An Error{kBadInput}, to be thrown with the file of the mesh. The hint names the properties that the mesh has, at most
// the first twenty.
Error missing_property(const std::string& name, std::span<const std::string> known);

}  // namespace reeb::io
