// The events of a mesh as text, one per line:
//
//   v INDEX X Y Z [VALUE ...]     t I J K     c I J K L [VALUE ...]     f INDEX
//
// A float32 is written as `%.9g` in the C locale, a float64 in the shortest form, so both are restored exactly; minus
// zero is -0. Further values are first the floats, then the integers of the vertex or cell.
#pragma once

#include <string>

#include "io/events/stream_event.h"
#include "io/text/output_buffer.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

void append_event(std::string& out, const StreamEvent& event, const StreamHeader& header);

// Writes the events of a batch of any mesh, with all coordinates and the first `properties` properties. `float64`:
// numbers need not be float32.
void write_events(OutputBuffer& out, const MeshBatch& batch, std::size_t properties, bool float64);

}  // namespace reeb::io
