// The subcommands of `reeb` for parts of a mesh (tools/commands/commands.h).
#pragma once

#include <CLI/CLI.hpp>

namespace reeb::tools {

void add_fragment(CLI::App& program);
void add_glue(CLI::App& program);

}  // namespace reeb::tools
