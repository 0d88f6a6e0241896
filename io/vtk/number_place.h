// Where an array of numbers is in a file of VTK, and how it is written.
#pragma once

#include <cstdint>

#include "io/decoding/vtk_data.h"
#include "io/mesh/scalar_bytes.h"

namespace reeb::io {

enum class NumberCoding : std::uint8_t {
  kText,
  kRaw,
  kBase64,
  kAppended  // raw or base64, at the end of the file: not yet known
};

struct NumberPlace {
  ScalarType type = ScalarType::kFloat32;
  NumberCoding coding = NumberCoding::kText;
  std::uint64_t offset = 0;  // of its first byte in the content
  // What is not text:
  bool big_endian = false;
  // In XML, bytes come after a header of numbers, of 64 bits if it is wide: their count, or the sizes of packed blocks.
  bool has_header = false, wide_header = false;
  BlockPacking packing = BlockPacking::kNone;
};

}  // namespace reeb::io
