// Data written in base64. Padding ends a group, not the data: several encoded pieces can follow each other.
#pragma once

#include <memory>

#include "io/decoding/byte_input.h"

namespace reeb::io {

// Ends before "<". read() THROWS: Error{kBadInput} with the place of anything else.
std::unique_ptr<ByteInput> from_base64(std::unique_ptr<ByteInput> text);

}  // namespace reeb::io
