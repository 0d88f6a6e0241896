// The events of a mesh as text, one per line:
//
//   v INDEX X Y Z [VALUE ...]     t I J K     c I J K L [VALUE ...]     f INDEX
//
// Floating-point numbers are written as `%.9g` in the C locale, which restores every float32; minus zero is -0. Further
// values are first the floats, then the integers of the vertex or cell.
#pragma once

#include <ostream>
#include <string>

#include "io/events/stream_event.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

void append_event(std::string& out, const StreamEvent& event, const StreamHeader& header);

// Writes every event of a streaming mesh, exactly as the file has them. If the reader throws, the events before the
// error are written first.
void write_events(EventReader& reader, std::ostream& out);
// Writes every event of any mesh, with any number of coordinates. The order is that of the file if the reader was
// opened with ReadOptions::batch_events == 1; otherwise events are grouped by batch.
void write_events(MeshReader& reader, std::ostream& out);

}  // namespace reeb::io
