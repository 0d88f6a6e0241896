// Detects the format of a streaming mesh from its content, and makes the reader.
#pragma once

#include <memory>
#include <string>

#include "io/events/byte_source.h"
#include "io/events/stream_event.h"

namespace reeb::io {

// Reads the head of a streaming mesh: SMA, SMB, SMC (versions 1 and 3), SVA or SVB. The suffix of `name` only decides
// between SVA and SMA where the content cannot.
// THROWS: Error{kBadInput}; for SMD, SVC, the SMC of 2003 and gzip it names the format.
std::unique_ptr<EventReader> open_stream(std::unique_ptr<ByteSource> source, const std::string& name = {});

// Whether the first byte alone shows a streaming mesh. Binary formats only: text can be something else.
bool looks_like_binary_stream(std::byte first);

}  // namespace reeb::io
