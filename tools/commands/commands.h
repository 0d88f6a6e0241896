// The subcommands of `reeb`, one file each. add_X adds its options and what it does when chosen.
#pragma once

#include <CLI/CLI.hpp>

namespace reeb::tools {

void add_extract(CLI::App& app);
void add_info(CLI::App& app);
void add_pairs(CLI::App& app);
void add_verify(CLI::App& app);

}  // namespace reeb::tools
