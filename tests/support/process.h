// Runs a program as a user would and says what came of it.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace reeb::test {

struct Command {
  std::vector<std::string> arguments;                                 // the first is the program, looked up in PATH
  std::vector<std::string> wrapper = {};                              // a program that starts it, with arguments
  std::string folder = {};                                            // to run in; empty: this one
  std::string input = "/dev/null";                                    // file that is its standard input
  std::vector<std::pair<std::string, std::string>> environment = {};  // on top of this process's
  std::uint64_t address_space_bytes = 0;                              // 0: as much as it likes
  unsigned most_seconds = 600;                                        // killed by SIGALRM after these
};

struct Outcome {
  int exit_code = 0;  // minus the signal that ended it
  std::string output, error;
  double seconds = 0;
  // Of the program alone, but never less than what this process held when it started the program.
  std::uint64_t peak_rss_bytes = 0;
};

// THROWS: std::system_error if no process can be made.
Outcome run_process(const Command& command);

// The command as a person would type it, for messages.
std::string describe(const Command& command);

}  // namespace reeb::test
