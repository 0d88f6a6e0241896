// Saves the input that crashes a program.
#pragma once

#include <string>

namespace reeb::test {

// From the first call on, a failure saves the current input to a file and prints its name. A failure is a signal, an
// abort, a finding of a sanitizer, or more than kMaxSecondsPerInput for one input.
// Null means that no input is running. REQUIRES: `bytes` lives until the next call.
void watch_input(const std::string* bytes, const std::string& target);
inline constexpr unsigned kMaxSecondsPerInput = 20;

}  // namespace reeb::test
