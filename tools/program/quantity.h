// Sizes and thresholds as users type them.
#pragma once

#include <cstdint>
#include <string>

namespace reeb::tools {

// Bytes: "4096", "64M", "1.5GiB" (K M G T count in 1024s, with or without "iB" or "B").
// THROWS: Error{kUsage}.
std::uint64_t parse_size(const std::string& text);

// "0.01" in units of the function, or "0.1%" of `range`. THROWS: Error{kUsage}.
double parse_threshold(const std::string& text, double range);

}  // namespace reeb::tools
