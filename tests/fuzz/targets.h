// The targets of fuzzing: one for every reader of the project, and the engine.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace reeb::test {

// A target depends on the bytes of its input only, so that an input can be run again.
struct FuzzTarget {
  std::string_view name;
  // Reads `bytes` in all ways that the reader has, which must agree. Returns whether everything was read without an
  // error. An Error of the project counts as false; anything else ends the process.
  bool (*run)(const std::string& bytes);
  // Good and bad files to start from; never empty.
  std::vector<std::string> (*corpus)();
  // Words of the format, in addition to numbers.
  std::span<const std::string_view> words;
  // Corrects checksums, since a wrong one would hide all faults after it; can be null.
  void (*fix_checksums)(std::string& bytes);
};

std::span<const FuzzTarget> fuzz_targets();
// Null if there is none.
const FuzzTarget* find_fuzz_target(std::string_view name);

}  // namespace reeb::test
