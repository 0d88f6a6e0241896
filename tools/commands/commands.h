// The subcommands of `reeb`, one file each. Each function adds its subcommand, options and help to the program; the
// callback does the work. Errors are thrown as reeb::Error.
#pragma once

#include "tools/arguments/arguments.h"

namespace reeb::tools {

void add_compute(Program& program);
void add_info(Program& program);
void add_extract(Program& program);
void add_pairs(Program& program);
void add_verify(Program& program);
void add_generate(Program& program);
void add_convert(Program& program);
void add_defects(Program& program);
void add_repair(Program& program);
void add_function(Program& program);
void add_segment(Program& program);
void add_plot(Program& program);
void add_report(Program& program);
void add_view(Program& program);

}  // namespace reeb::tools
