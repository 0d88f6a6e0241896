// Data written as hexadecimal digits, two a byte, with or without white space between bytes.
#pragma once

#include <memory>

#include "io/images/byte_input.h"

namespace reeb::io {

// read() THROWS: Error{kBadInput} with the place of anything else.
std::unique_ptr<ByteInput> from_hex(std::unique_ptr<ByteInput> text);

}  // namespace reeb::io
