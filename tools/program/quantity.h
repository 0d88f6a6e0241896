// Sizes, counts and thresholds as users type them.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "libreeb/base/value_range.h"

namespace reeb::tools {

// Bytes: "4096", "64M", "1.5GiB" (K M G T count in 1024s, in either case, with or without "iB" or "B"). Here and below,
// `option` is what errors name.
// THROWS: Error{kUsage}.
std::uint64_t parse_size(const std::string& option, const std::string& text);

struct CountLimits {
  std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
};

// A whole number: "50000", "50k", "1.5M", "1e6" (k M G T count in 1000s, in either case).
// THROWS: Error{kUsage}.
std::uint64_t parse_count(const std::string& option, const std::string& text, CountLimits limits = {});

// "0.01" in units of the function, or "0.1%" or "0.1 %" of `range`. THROWS: Error{kUsage}.
double parse_threshold(const std::string& option, const std::string& text, const ValueRange& range);

// "the threshold 4 is more than the range 0.144443 of y; did you mean 4%?" Empty if it is not, or the range is one
// value. REQUIRES: parse_threshold() takes the text.
std::string large_threshold(const std::string& text, const ValueRange& range, const std::string& function);

// The difference of two values of the range in per cent of it, without overflow. REQUIRES: range.min < range.max.
double percent_of(const ValueRange& range, double lo, double hi);

// "1%" or "1 %", from 0 to 100. THROWS: Error{kUsage} with this hint.
double parse_share(const std::string& option, const std::string& text, const std::string& hint);

// "2.5" in units of the mesh. THROWS: Error{kUsage}.
double parse_length(const std::string& option, const std::string& text);

}  // namespace reeb::tools
