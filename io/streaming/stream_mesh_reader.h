// Streaming meshes through the port that all formats share (libreeb/port/mesh_reader.h).
#pragma once

#include <memory>
#include <string>

#include "io/events/stream_event.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Names for the further values of the vertices of a volume mesh, which have none in the file: "s0", "s1", ... for
// floats, "i0", "i1", ... for integers.
std::vector<std::string> stream_property_names(const StreamHeader& header);

// Post-order streams are turned into pre-order (pre_order.h). SMA, SMB and SMC deliver triangles, SVA and SVB
// tetrahedra; values of cells are not delivered. The warnings count the vertices that were never finalized.
// THROWS: Error{kBadInput} if the mesh does not have a requested property.
std::unique_ptr<MeshReader> make_stream_mesh_reader(std::unique_ptr<EventReader> reader,
                                                    const ReadOptions& options = {}, std::uint64_t file_bytes = 0);

}  // namespace reeb::io
