// The commands of the program, called as functions: many runs in one process, which tests can watch and disturb.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace reeb::test {

struct CommandOutcome {
  int exit_code = 0;
  std::string message, file, hint;  // of the error
  std::string output;               // on standard output
};

// Runs `reeb WORDS...` in this process and folder, with the file `input` as standard input. Messages are dropped.
// `around` is given the work of the command, to call it; what this function does itself is not in it.
// THROWS: what is neither an Error nor std::bad_alloc.
CommandOutcome run_command(
    const std::vector<std::string>& words, const std::string& input = "/dev/null",
    const std::function<void(const std::function<void()>&)>& around = [](const auto& work) { work(); });

}  // namespace reeb::test
