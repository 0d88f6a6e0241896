// What can be said about an input before its first byte is read.
#pragma once

#include <string>

namespace reeb::io {

// THROWS: Error{kBadInput} with a hint: absent, a directory, or not readable by this user.
void check_input_file(const std::string& path);

[[noreturn]] void throw_empty(const std::string& path);

}  // namespace reeb::io
