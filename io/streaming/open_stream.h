// Streaming meshes from files, pipes and compressed streams, event by event.
#pragma once

#include <memory>
#include <string>

#include "io/events/stream_event.h"
#include "io/file/content_source.h"

namespace reeb::io {

// Detects the format of a streaming mesh from its content, and reads its head: SMA, SMB, SMC (versions 1 and 3), SVA or
// SVB. The suffix of `path` only decides between SVA and SMA where the content cannot. A pipe is decoded as its bytes
// arrive.
// THROWS: Error{kBadInput} with the name of the source, as the errors of the reader; for SMD, SVC, the SMC of 2003 and
//         gzip it names the format.
std::unique_ptr<EventReader> open_stream(std::unique_ptr<ContentSource> source, const std::string& path = {});

// Whether the first byte alone shows a streaming mesh. Binary formats only: text can be something else.
bool looks_like_binary_stream(char first);

}  // namespace reeb::io
