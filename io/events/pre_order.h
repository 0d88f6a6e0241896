// Turns a post-order stream into a pre-order one: each cell waits for the last of its vertices.
#pragma once

#include <memory>

#include "io/events/stream_event.h"

namespace reeb::io {

// Delivers each vertex when it arrives, each cell directly after the last of its vertices, and each finalization after
// the last cell that uses the vertex. Vertices keep their numbers. A pre-order `reader` is returned unchanged.
// MEMORY: the waiting cells and the vertices that they name: the front of the stream.
std::unique_ptr<EventReader> in_pre_order(std::unique_ptr<EventReader> reader);

}  // namespace reeb::io
