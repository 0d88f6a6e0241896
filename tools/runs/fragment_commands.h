// The subcommands of `reeb` for parts of a mesh (tools/commands/commands.h).
#pragma once

#include "tools/arguments/arguments.h"

namespace reeb::tools {

void add_fragment(Program& program);
void add_glue(Program& program);

}  // namespace reeb::tools
