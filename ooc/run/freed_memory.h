// Returns memory to the system, between two stages or now and then.
#pragma once

namespace reeb::ooc {

// Returns what was freed. A stage frees many small blocks. The next stage needs blocks of other sizes, which would take
// new memory in addition.
void return_freed_memory();

// Returns the pages of the program and its libraries, since a start and each stage need others of them. Those that are
// needed again are mapped again from their files, which takes some microseconds for 64 KiB. Does nothing under a
// debugger, which writes its breakpoints into these pages, nor before own_process().
void return_code();

// To be called by a program that has the process for itself. Other programs that use the library may have changed pages
// of code, and would lose the changes.
void own_process();

}  // namespace reeb::ooc
