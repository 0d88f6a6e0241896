// Files without a header: the user says what they hold.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/images/image.h"

namespace reeb::io {

struct RawGrid {
  std::vector<std::uint64_t> size;  // 2 or 3 axes, that which varies fastest first; empty: not given
  ScalarType type = ScalarType::kUint8;
  bool big_endian = false;
  std::vector<double> spacing;  // one number for each axis; empty: 1
  std::uint64_t skip_bytes = 0;
};

// "256x256x100" or "512x512". THROWS: Error{kUsage}.
std::vector<std::uint64_t> parse_grid_size(const std::string& grid);

// From what a user writes: "256x256x100", "u16le", "0.5,0.5,2" (or empty).
// THROWS: Error{kUsage} that names the option.
RawGrid parse_raw_grid(const std::string& grid, const std::string& type, const std::string& spacing,
                       std::uint64_t skip_bytes);

Image raw_image(const RawGrid& grid);

}  // namespace reeb::io
