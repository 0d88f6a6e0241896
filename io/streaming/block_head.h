// The head of SMB and SVB files, and their byte order.
//
// The byte order mark of old files often contradicts the data: programs built for 64-bit machines
// took these for big endian. So the head and the first blocks are judged in both orders, by how
// many elements are nonsense, and the mark is overruled where the other order is better.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "io/events/byte_source.h"
#include "io/events/stream_event.h"

namespace reeb::io {

inline constexpr std::size_t kBlockElements = 32;

// 32-bit words of a file in either byte order.
struct WordOrder {
  bool swapped = false;  // against this machine

  static WordOrder big_endian(bool big) { return {big == (std::endian::native == std::endian::little)}; }
  std::uint32_t word(const std::byte* at) const {
    std::uint32_t value;
    std::memcpy(&value, at, sizeof value);
    return swapped ? __builtin_bswap32(value) : value;
  }
  std::int32_t integer(const std::byte* at) const { return static_cast<std::int32_t>(word(at)); }
  float real(const std::byte* at) const { return std::bit_cast<float>(word(at)); }
};

struct BlockHead {
  StreamHeader header;
  WordOrder order;
  bool overruled = false;  // the byte order mark was wrong
};

// Reads the head of an SMB file, or of an SVB file where `volume`, and skips it in the window.
// THROWS: TRUNCATED, BAD_HEADER, UNSUPPORTED.
BlockHead read_block_head(ByteWindow& window, bool volume);

}  // namespace reeb::io
