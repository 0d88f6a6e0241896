// NumPy arrays (.npy), versions 1 to 3, with 2 or 3 axes. i is the axis whose values are next to each other in the
// file: the last one in C order, the first one in Fortran order. Vertex (i, j, k) is at that point.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/images/image.h"

namespace reeb::io {

struct NumpyHeader {
  ScalarType type = ScalarType::kFloat64;
  bool big_endian = false;
  std::vector<std::uint64_t> shape;  // as NumPy shows it
  bool fortran_order = false;
  std::uint64_t body_offset = 0;
};

// `head` is the beginning of the file: all of it, or ContentSource::kLookahead bytes.
// THROWS: Error{kBadInput} with the byte offset in the file `name`.
NumpyHeader parse_numpy_header(std::string_view head, const std::string& name);

// What comes before `count` little-endian float64 in a file of version 1: 128 bytes, whatever the count.
std::string numpy_header(std::uint64_t count);

bool is_numpy(std::string_view head);

// THROWS: Error{kBadInput} with the byte offset.
Image parse_numpy(ContentSource& source);

}  // namespace reeb::io
