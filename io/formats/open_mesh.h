// Opens a mesh of any supported format, which is detected from the content, or chosen.
#pragma once

#include <memory>
#include <string>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class ContentSource;

// Opens `path` ("-": standard input), decompresses gzip and zstd, and reads the header. Uncompressed binary PLY with
// vertices of fixed size also has MeshReader::indexed(), which does not open the file again.
// `format`: "ply", "cx", ... where the content does not tell, and the name has no suffix that does; empty: detected.
// THROWS: Error{kUsage} for another format; Error{kBadInput} with file, position and a hint: unreadable, a directory,
// empty, of an unknown format, a
//         damaged header, a property that the mesh does not have.
// THREADS: any number of calls at the same time; "-" once.
std::unique_ptr<MeshReader> open_mesh(const std::string& path, const ReadOptions& options = {},
                                      const std::string& format = {});

// The same for content that is open already; views of its beginning may have been taken. `path` decides between formats
// where the content cannot (format_detection.h).
std::unique_ptr<MeshReader> open_mesh(std::unique_ptr<ContentSource> source, const std::string& path,
                                      const ReadOptions& options = {}, const std::string& format = {});

}  // namespace reeb::io
