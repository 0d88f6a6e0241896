// How the program handles signals.
#pragma once

#include <sys/types.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace reeb::tools {

// Writing to a pipe without a reader, or to a file that may not grow, becomes an error of the write instead of ending
// the process. SIGINT, SIGTERM and SIGHUP (unless it is ignored, as by nohup) end the process at once, with a message
// (if `speaks`) and the exit code of an interruption; no temporary file is left.
void handle_signals(bool speaks = true);

// From the first call of the returned function on, and as long as it or a copy of it exists, the first of these signals
// only makes it return true, so that the run can be saved. The second ends the process at once. A signal that nobody
// asked for any more is forgotten.
std::function<bool()> watch_signals();

struct Child {
  std::string program;  // its path, or a name in PATH
  std::vector<std::string> arguments;
  std::array<int, 3> streams;  // descriptors for its standard input, output and error
  bool is_apart = false;       // in a group of its own: Ctrl-C here does not end it
};
struct StartedChild {
  int error = 0;  // of the system, if it could not be started
  pid_t process = 0;
};
// Starts a program, with the usual handling of signals. One of the signals above ends a child that is not apart, too,
// until forget_child() is called.
StartedChild start_child(const Child& child);
void forget_child();

}  // namespace reeb::tools
