// Streaming meshes from files, pipes and compressed streams, event by event.
#pragma once

#include <memory>
#include <string>

#include "io/events/stream_event.h"
#include "io/file/content_source.h"

namespace reeb::io {

// The content must be that of a streaming mesh (format_detection.h); `path` tells SVA from SMA
// where the content does not. What a pipe holds is decoded as it comes.
// THROWS: as open_stream(), with the name of the source; so do the reader's errors.
std::unique_ptr<EventReader> open_events(std::unique_ptr<ContentSource> source, const std::string& path);

}  // namespace reeb::io
