// Runs a program as a user would, and reports the outcome.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace reeb::test {

struct Command {
  std::vector<std::string> arguments;                                 // the first is the program, looked up in PATH
  std::vector<std::string> wrapper = {};                              // a program that starts it, with arguments
  std::string folder = {};                                            // where to run; empty: the current folder
  std::string input = "/dev/null";                                    // file that is its standard input
  std::vector<std::pair<std::string, std::string>> environment = {};  // in addition to that of this process
  std::uint64_t address_space_bytes = 0;                              // 0: unlimited
  unsigned most_seconds = 600;                                        // then SIGALRM kills it
};

struct Outcome {
  int exit_code = 0;  // minus the signal that ended it
  std::string output, error;
  double seconds = 0;
  // Of the program alone, but at least what this process held when it started the program.
  std::uint64_t peak_rss_bytes = 0;
};

// THROWS: std::system_error if no process can be made.
Outcome run_process(const Command& command);

// The command as a person would type it, for messages.
std::string describe(const Command& command);

}  // namespace reeb::test
