// The events of a mesh as text, one a line:
//
//   v INDEX X Y Z [VALUE ...]     t I J K     c I J K L [VALUE ...]     f INDEX
//
// Floating-point numbers as `%.9g` in the C locale, which restores every float32; minus zero is
// -0. Further values are first the floats, then the integers of the vertex or cell.
#pragma once

#include <ostream>
#include <string>

#include "io/events/stream_event.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

void append_event(std::string& out, const StreamEvent& event, const StreamHeader& header);

// Every event of a streaming mesh, exactly as the file has them. What came before an error is
// written before the error passes on.
void write_events(EventReader& reader, std::ostream& out);
// Every event of any mesh. The order is that of the file if its reader was opened with
// ReadOptions::batch_events == 1, and by batches otherwise. Coordinates of any number.
void write_events(MeshReader& reader, std::ostream& out);

}  // namespace reeb::io
