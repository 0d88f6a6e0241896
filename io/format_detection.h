// Which format an input is in, told by its first bytes.
#pragma once

#include <string>

#include "io/content_source.h"

namespace reeb::io {

enum class MeshFormat { kUnknown, kPly, kOff, kAsciiStl, kBinaryStl, kObj, kStreaming };

// `path` decides only where content cannot: between OBJ and the text form of streaming meshes,
// which share their lines v and f.
MeshFormat detect_format(ContentSource& source, const std::string& path);

}  // namespace reeb::io
