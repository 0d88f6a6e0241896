// Where something is in a text, for messages of readers that do not count lines.
#pragma once

#include <cstdint>
#include <string>

#include "io/file/content_source.h"

namespace reeb::io {

// "line:column" of an offset. It reads everything before it. REQUIRES: content.reopen() is not null.
std::string text_position(const ContentSource& content, std::uint64_t offset);

}  // namespace reeb::io
