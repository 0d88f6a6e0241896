// What is fuzzed: one target for every reader of the project.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace reeb::test {

// An input as a target sees it. All randomness is in here, so that an input repeats itself.
struct FuzzTarget {
  std::string_view name;
  // Reads `bytes` in the ways that the reader knows, which must agree. Returns whether the whole of
  // it was read without an error; does not return from anything but that and an Error of the project.
  bool (*run)(const std::string& bytes);
  // Good and bad files to start from; never empty.
  std::vector<std::string> (*corpus)();
  // Words of the format's texts, besides numbers.
  std::span<const std::string_view> words;
  // Mends checksums that would hide everything behind them; may be null.
  void (*mend)(std::string& bytes);
};

std::span<const FuzzTarget> fuzz_targets();
// Null if there is none.
const FuzzTarget* find_fuzz_target(std::string_view name);

}  // namespace reeb::test
