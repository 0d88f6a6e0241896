// Keeps the input that a program dies of.
#pragma once

#include <string>

namespace reeb::test {

// From the first call on: if the process dies by a signal, an abort or a sanitizer's finding, or takes
// longer than kMostSeconds for one input, the input goes to a file whose name is printed.
// REQUIRES: `bytes` outlives the next call. Null: nothing is being run.
void watch_input(const std::string* bytes, const std::string& target);
inline constexpr unsigned kMostSeconds = 20;

}  // namespace reeb::test
