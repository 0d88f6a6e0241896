// Streaming meshes through the port that all formats share (libreeb/port/mesh_reader.h).
#pragma once

#include <memory>
#include <string>

#include "io/events/stream_event.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Post-order streams are turned into pre-order (pre_order.h). SMA, SMB and SMC deliver triangles, SVA and SVB
// tetrahedra; values of cells are not delivered. The further values of vertices have no names in the file; they are the
// properties "s0", "s1", ... (floats) and "i0", "i1", ... (integers). The warnings count the vertices that were never
// finalized.
// THROWS: Error{kBadInput} if the mesh does not have a requested property.
std::unique_ptr<MeshReader> make_stream_mesh_reader(std::unique_ptr<EventReader> reader,
                                                    const ReadOptions& options = {}, std::uint64_t file_bytes = 0);

}  // namespace reeb::io
