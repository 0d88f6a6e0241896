// What remains of shares, as bytes: in fragments, and between processes (docs/FORMAT.md).
#pragma once

#include "libreeb/base/state_stream.h"
#include "libreeb/parts/open_part.h"

namespace reeb::ooc {

void write_open_part(StateWriter& out, const OpenPart& part);
// THROWS: DamagedState unless check_open_part() holds for it.
void read_open_part(StateReader& in, std::uint32_t parts, OpenPart& part);

}  // namespace reeb::ooc
