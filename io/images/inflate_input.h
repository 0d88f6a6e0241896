// Data packed with zlib or gzip inside a file.
#pragma once

#include <memory>

#include "io/images/byte_input.h"

namespace reeb::io {

// No more than this many bytes come of one packed byte.
inline constexpr std::uint64_t kMostInflated = 1032;

// One zlib stream, or gzip members, one after the other. Bytes after it are not read.
// read() THROWS: Error{kBadInput} with the place where the stream is damaged or ends too early.
std::unique_ptr<ByteInput> inflate(std::unique_ptr<ByteInput> packed);

}  // namespace reeb::io
