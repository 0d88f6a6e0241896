// The subcommands of `reeb`, one file each. Each function adds its subcommand, options and help to the program; the
// callback does the work. Errors are thrown as reeb::Error.
#pragma once

#include <CLI/CLI.hpp>

namespace reeb::tools {

void add_compute(CLI::App& program);
void add_info(CLI::App& program);
void add_extract(CLI::App& program);
void add_pairs(CLI::App& program);
void add_verify(CLI::App& program);
void add_generate(CLI::App& program);
void add_convert(CLI::App& program);
void add_defects(CLI::App& program);
void add_repair(CLI::App& program);
void add_function(CLI::App& program);
void add_segment(CLI::App& program);
void add_plot(CLI::App& program);
void add_report(CLI::App& program);
void add_view(CLI::App& program);

}  // namespace reeb::tools
