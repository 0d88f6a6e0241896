// Opens a mesh of any supported format; the format is told by content, never by name.
#pragma once

#include <memory>
#include <string>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class ContentSource;

// Opens `path` ("-": standard input), unwrapping gzip and zstd, and reads its header. The file is opened
// once, and so is MeshReader::indexed() on it, which uncompressed binary PLY with vertices of fixed size has.
// THROWS: Error{kBadInput} with file, position and a hint: unreadable, a directory, empty, of an
//         unknown format, a damaged header, a property that the mesh lacks.
// THREADS: any number of calls at the same time; "-" once.
std::unique_ptr<MeshReader> open_mesh(const std::string& path, const ReadOptions& options = {});

// The same for content that was opened, and perhaps looked at, before. `path` tells formats apart
// where the content does not.
std::unique_ptr<MeshReader> open_mesh(std::unique_ptr<ContentSource> source, const std::string& path,
                                      const ReadOptions& options = {});

}  // namespace reeb::io
