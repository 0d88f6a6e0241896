// Streaming meshes from files, pipes and compressed streams, event by event.
#pragma once

#include <memory>
#include <string>

#include "io/events/stream_event.h"
#include "io/file/content_source.h"

namespace reeb::io {

// The content must be a streaming mesh (format_detection.h). `path` decides between SVA and SMA where the content
// cannot. A pipe is decoded as its bytes arrive.
// THROWS: as open_stream(), with the name of the source. The errors of the reader have that name too.
std::unique_ptr<EventReader> open_events(std::unique_ptr<ContentSource> source, const std::string& path);

}  // namespace reeb::io
