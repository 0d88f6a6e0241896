// Streaming meshes through the port that all formats share (libreeb/port/mesh_reader.h).
#pragma once

#include <memory>
#include <string>

#include "io/events/stream_event.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Names of the scalars of a volume mesh's vertices, which have none in the file: further floats
// are "s0", "s1", ..., integers "i0", "i1", ...
std::vector<std::string> stream_property_names(const StreamHeader& header);

// Post-order streams are turned into pre-order on the way (pre_order.h). Triangles of SMA, SMB and
// SMC arrive as triangles, cells of SVA and SVB as tetrahedra; values of cells are not delivered.
// Vertices that were never finalized are counted in the warnings.
// THROWS: Error{kBadInput} if the mesh lacks a property that is asked for.
std::unique_ptr<MeshReader> make_stream_mesh_reader(std::unique_ptr<EventReader> reader,
                                                    const ReadOptions& options = {}, std::uint64_t file_bytes = 0);

}  // namespace reeb::io
