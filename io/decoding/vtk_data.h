// The binary data of an array in a VTK XML file: a head that says how many bytes follow, or in which blocks they are
// packed, and the bytes.
#pragma once

#include <cstdint>
#include <memory>

#include "io/decoding/byte_input.h"

namespace reeb::io {

struct VtkDataKind {
  enum class Packing { kNone, kZlib, kLz4 };
  Packing packing = Packing::kNone;
  bool wide_head = false;  // numbers of the head have 8 bytes, else 4
  bool big_endian = false;
  std::uint64_t bytes = 0;  // of the array, unpacked
};

// The least number of bytes in the file.
std::uint64_t least_stored_bytes(const VtkDataKind& kind);

// MEMORY: a block, which is refused if it has more than 64 MB, packed and unpacked; 4 bytes for each block.
// read() THROWS: Error{kBadInput} if the data are damaged, or are not `kind.bytes` bytes.
std::unique_ptr<ByteInput> vtk_data(std::unique_ptr<ByteInput> stored, const VtkDataKind& kind);

}  // namespace reeb::io
