// The head of SMB and SVB files, and their byte order.
//
// The byte order mark of old files often contradicts the data: programs built for 64-bit machines took those for big
// endian. So the head and the first blocks are read in both orders. If the other order gives fewer elements that make
// no sense, it overrules the mark.
#pragma once

#include <cstddef>

#include "io/events/stream_event.h"
#include "io/text/cursor.h"

namespace reeb::io {

inline constexpr std::size_t kBlockElements = 32;
inline constexpr std::size_t kMaxComments = 65535;

struct BlockHead {
  StreamHeader header;
  bool swap = false;       // its words are big endian
  bool overruled = false;  // the byte order mark was wrong
};

// Reads the head of an SMB file, or of an SVB file if `volume`, and moves past it.
// THROWS: TRUNCATED, BAD_HEADER, UNSUPPORTED.
BlockHead read_block_head(Cursor& cursor, bool volume);

}  // namespace reeb::io
