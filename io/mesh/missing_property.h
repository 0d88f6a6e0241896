// What a user is told who names a vertex property that a mesh does not have.
#pragma once

#include <span>
#include <string>

#include "libreeb/base/error.h"

namespace reeb::io {

// An Error{kBadInput}, to be thrown with the mesh's name. The hint names the first of the properties that it has.
Error missing_property(const std::string& name, std::span<const std::string> known);

}  // namespace reeb::io
