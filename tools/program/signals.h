// How the program handles signals.
#pragma once

#include <functional>

namespace reeb::tools {

// Writing to a pipe without a reader, or to a file that may not grow, becomes an error of the write instead of ending
// the process.
void turn_signals_into_errors();

// From now on, the first SIGINT or SIGTERM makes the returned function return true; the second ends the process at
// once.
std::function<bool()> watch_signals();

}  // namespace reeb::tools
