// The binary data of an array in a VTK XML file: a head that says how many bytes follow, or in which blocks they are
// packed, and the bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "io/decoding/byte_input.h"

namespace reeb::io {

enum class BlockPacking : std::uint8_t { kNone, kZlib, kLz4 };

struct VtkDataKind {
  BlockPacking packing = BlockPacking::kNone;
  bool wide_head = false;  // numbers of the head have 8 bytes, else 4
  bool big_endian = false;
  std::optional<std::uint64_t> bytes{};  // of the array, unpacked, if that is known
};

// The least number of bytes in the file. REQUIRES: kind.bytes.
std::uint64_t least_stored_bytes(const VtkDataKind& kind);

class VtkData : public ByteFilter {
 public:
  using ByteFilter::ByteFilter;
  // Bytes of the array, unpacked, as its head says.
  virtual std::uint64_t size() const = 0;
};

// Reads the head.
// MEMORY: a block, which is refused if it has more than 64 MB, packed and unpacked; 4 bytes for each block.
// THROWS, as read(): Error{kBadInput} if the data are damaged, or are not `kind.bytes` bytes.
std::unique_ptr<VtkData> vtk_data(std::unique_ptr<ByteInput> stored, const VtkDataKind& kind);

}  // namespace reeb::io
