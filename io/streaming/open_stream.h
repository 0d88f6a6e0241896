// Tells the streaming mesh formats apart by content and makes the reader.
#pragma once

#include <memory>
#include <string>

#include "io/events/byte_source.h"
#include "io/events/stream_event.h"

namespace reeb::io {

// Reads the head of a streaming mesh: SMA, SMB, SMC (versions 1 and 3), SVA or SVB. `name` only
// tells SVA from SMA where the content does not, by its suffix.
// THROWS: Error{kBadInput}, also for SMD, SVC, the SMC of 2003 and for gzip, all by name.
std::unique_ptr<EventReader> open_stream(std::unique_ptr<ByteSource> source, const std::string& name = {});

// Whether a file that starts with `first` is a streaming mesh by its first byte alone: binary
// formats only, since text may be other things too.
bool looks_like_binary_stream(std::byte first);

}  // namespace reeb::io
