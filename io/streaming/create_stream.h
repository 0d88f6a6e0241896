// Writes streaming meshes and lists of events to files, by the suffix of the name.
#pragma once

#include <memory>
#include <string>

#include "io/events/stream_writer.h"
#include "io/mesh/mesh_writer_options.h"
#include "libreeb/port/mesh_writer.h"

namespace reeb::io {

enum class StreamFormat { kNone, kText, kBlocks, kCompressed, kEvents };

// .sma .sva: text; .smb .svb: blocks; .smc: compressed; .events.txt: events; else none.
StreamFormat stream_format(const std::string& path);
bool is_volume_name(const std::string& path);  // .sva .svb

// A writer of events to the file `path`, which gets its name on close().
// REQUIRES: stream_format(path) is not kNone.
// THROWS: as AtomicFile, and as the writers of stream_writer.h.
std::unique_ptr<StreamWriter> create_stream(const std::string& path, const StreamHeader& header, Existing existing);

// The same for batches. A triangle format gets the triangles of cells; volume formats and lists of events get
// tetrahedra, and keep properties. An edge or a point is a degenerate triangle in all of them. Numbers become float32,
// but for lists of events.
std::unique_ptr<MeshWriter> create_stream_mesh(const std::string& path, const MeshWriterOptions& options);

}  // namespace reeb::io
