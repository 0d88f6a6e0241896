// What the program does about signals.
#pragma once

#include <functional>

namespace reeb::tools {

// A pipe that nobody reads and a file that may not grow are errors of the write, not ends of the
// process.
void turn_signals_into_errors();

// From now on the first SIGINT or SIGTERM makes the returned function answer true; the second ends
// the process at once.
std::function<bool()> watch_signals();

}  // namespace reeb::tools
