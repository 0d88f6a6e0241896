// Which format an input is in, told by its first bytes.
#pragma once

#include <string>

#include "io/file/content_source.h"

namespace reeb::io {

enum class MeshFormat { kUnknown, kPly, kOff, kAsciiStl, kBinaryStl, kObj, kStreaming };

// `path` decides only where content cannot: between OBJ and the text form of streaming meshes,
// which share their lines v and f, and for damaged streaming meshes. A stream in post-order, of
// tetrahedra or with explicit finalization shows in its lines; one without these and without a head
// reads as OBJ, which is the same mesh. Of a pipe no more is waited for than it takes: most streaming
// meshes show in their first 80 bytes.
MeshFormat detect_format(ContentSource& source, const std::string& path);

}  // namespace reeb::io
