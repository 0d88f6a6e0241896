// How the program handles signals.
#pragma once

#include <sys/types.h>

#include <functional>

namespace reeb::tools {

// Writing to a pipe without a reader, or to a file that may not grow, becomes an error of the write instead of ending
// the process. SIGINT, SIGTERM and SIGHUP (unless it is ignored, as by nohup) end the process at once, with a message
// (if `speaks`) and the exit code of an interruption; no temporary file is left.
void handle_signals(bool speaks = true);

// From the first call of the returned function on, and as long as it or a copy of it exists, the first of these signals
// only makes it return true, so that the run can be saved. The second ends the process at once. A signal that nobody
// asked for any more is forgotten.
std::function<bool()> watch_signals();

// A process that such a signal ends, too; 0: none.
void end_together_with(pid_t child);

}  // namespace reeb::tools
