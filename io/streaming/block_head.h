// The head of SMB and SVB files, and their byte order.
//
// The byte order mark of old files often contradicts the data: programs built for 64-bit machines took those for big
// endian. So the head and the first blocks are read in both orders. If the other order gives fewer elements that make
// no sense, it overrules the mark.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "io/events/stream_event.h"
#include "io/text/cursor.h"

namespace reeb::io {

inline constexpr std::size_t kBlockElements = 32;

// Reads 32-bit words in either byte order.
struct WordOrder {
  bool swapped = false;  // relative to this machine

  static WordOrder big_endian(bool big) { return {big == (std::endian::native == std::endian::little)}; }
  std::uint32_t word(const char* at) const {
    std::uint32_t value;
    std::memcpy(&value, at, sizeof value);
    return swapped ? __builtin_bswap32(value) : value;
  }
  std::int32_t integer(const char* at) const { return static_cast<std::int32_t>(word(at)); }
  float real(const char* at) const { return std::bit_cast<float>(word(at)); }
};

struct BlockHead {
  StreamHeader header;
  WordOrder order;
  bool overruled = false;  // the byte order mark was wrong
};

// Reads the head of an SMB file, or of an SVB file if `volume`, and moves past it.
// THROWS: TRUNCATED, BAD_HEADER, UNSUPPORTED.
BlockHead read_block_head(Cursor& cursor, bool volume);

}  // namespace reeb::io
