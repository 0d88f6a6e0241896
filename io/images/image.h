// An image as its header describes it: the grid, and how the values are stored.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/decoding/byte_input.h"
#include "io/file/content_source.h"
#include "io/mesh/scalar_bytes.h"
#include "libreeb/port/grid_reader.h"

namespace reeb::io {

enum class Packing {
  kPlain,
  kZlib,  // or gzip
  kHex,   // two digits a byte
  kText,  // numbers
  kOwn    // Image::open_bytes
};

struct Image {
  GridInfo info;

  ScalarType type = ScalarType::kFloat64;
  bool big_endian = false;
  Packing packing = Packing::kPlain;
  // Value = stored * slope + intercept, if it is scaled.
  bool scaled = false;
  double slope = 1, intercept = 0;

  // The file of the data, as the header names it; empty: the data follow the header.
  std::string data_file;
  // Where the data are: after `offset` bytes of the content, then `skip_lines` lines, then `skip_bytes` bytes, which
  // count after unpacking; or at the end of the content.
  std::uint64_t offset = 0;
  std::uint64_t skip_lines = 0, skip_bytes = 0;
  bool ends_content = false;
  std::uint64_t text_line = 1, text_column = 1;  // the place of the data in a text
  bool must_end = false;                         // bytes after the last value are an error

  // kOwn: from the content to the bytes of the values, and the least number of bytes that the content needs for them.
  std::function<std::unique_ptr<ByteInput>(std::unique_ptr<ContentSource>)> open_bytes;
  std::uint64_t least_bytes = 0;
  bool commas = false;                       // separate numbers of text, too
  bool own_text = false;                     // those bytes are text
  std::optional<std::uint64_t> first_value;  // its offset, if the values are stored as they are
  bool from_start = false;                   // the content must be opened again for them

  std::vector<std::string> warnings;
};

inline constexpr std::uint64_t kMostGridValues = std::uint64_t{1} << 56;

// Sets axes and sizes. THROWS: Error{kBadInput} without a place: not 2 or 3 axes, a size of 0, more than 2^56 values.
// REQUIRES: info.components is set.
void set_size(GridInfo& info, std::span<const std::uint64_t> sizes);

}  // namespace reeb::io
