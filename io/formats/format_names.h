// The formats of meshes that are read, by the names that `--format` takes.
#pragma once

#include <string>

#include "io/formats/format_detection.h"

namespace reeb::io {

// THROWS: Error{kUsage} that lists the names.
void check_format_name(const std::string& name);

// The format of that name, for content where it cannot be told. Whether STL is text or binary, its content tells.
// THROWS: as check_format_name(); Error{kBadInput} if the content is for sure of another format.
MeshFormat chosen_format(const std::string& name, ContentSource& source);

// The name that decides where the content of a streaming mesh cannot: `path`, unless a format was chosen.
std::string name_for_streams(const std::string& path, const std::string& format);

}  // namespace reeb::io
