// What a format of streaming meshes cannot hold.
#pragma once

#include <string>

#include "io/events/stream_event.h"

namespace reeb::io {

// THROWS: Error{kBadInput} if a cell is not of the kind that the file holds.
void require_cell_kind(EventKind kind, bool volume);
[[noreturn]] void fail_format(const std::string& what, const std::string& hint);

}  // namespace reeb::io
