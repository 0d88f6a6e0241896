// Detects the format of an input from its first bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "io/file/content_source.h"

namespace reeb::io {

enum class MeshFormat {
  kUnknown,
  kPly,
  kOff,
  kAsciiStl,
  kBinaryStl,
  kObj,
  kStreaming,
  kCx,
  kVtkLegacy,
  kVtkXml,
  kMsh,
  kMedit,
  kTetgen
};

// "PLY", "streaming mesh"; "unknown" for kUnknown.
std::string_view format_name(MeshFormat format);

// A content whose first bytes say for sure what it is.
struct MarkedContent {
  MeshFormat format = MeshFormat::kUnknown;  // also of images, and of what is not read
  std::string_view name;                     // "PLY", "an NRRD image", "a Reeb graph"
};
// Nothing if the content has no mark. It looks at the first bytes only, at least `min_bytes` of them
// (content_source.h).
std::optional<MarkedContent> marked_content(ContentSource& source, std::size_t min_bytes = ContentSource::kLookahead);

// `path` decides only where the content cannot: TetGen, whose files are numbers; between OBJ and the text form of
// streaming meshes, which share their lines v and f, and for damaged streaming meshes and binary STL files. A text
// stream is recognized by its head, by post-order, by tetrahedra or by explicit finalizations. A stream with none of
// these is read as OBJ, which gives the same mesh. CX is told by its name alone. On a pipe it waits only for the bytes
// that it needs: most streaming meshes are recognized by their first 80 bytes.
MeshFormat detect_format(ContentSource& source, const std::string& path);

// Where the first line ends, if this is text whose lines end with CR alone. `format` is that of the content.
std::optional<std::size_t> bare_return(ContentSource& source, MeshFormat format);

// Whether content that is STL is text.
bool is_text_stl(ContentSource& source);

}  // namespace reeb::io
