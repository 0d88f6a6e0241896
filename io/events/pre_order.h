// Turns a post-order stream into a pre-order one: cells wait until their last vertex has come.
#pragma once

#include <memory>

#include "io/events/stream_event.h"

namespace reeb::io {

// Delivers each vertex when it arrives, each cell directly after the last of its vertices, and
// each finalization after the last cell that uses the vertex. Numbers are those of the file. A
// pre-order `reader` is given back as it is.
// MEMORY: the waiting cells and the vertices that they name, which is the front of the stream.
std::unique_ptr<EventReader> in_pre_order(std::unique_ptr<EventReader> reader);

}  // namespace reeb::io
