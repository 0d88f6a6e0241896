// Where a command's result goes: a file that appears whole, or standard output.
#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace reeb::tools {

// THROWS: Error{kBadInput} if `path` exists and `force` is not given, or is a folder. Nothing for "" and "-".
void refuse_existing(const std::string& path, bool force);

// Calls `write` with the stream of `path`, or standard output for "" and "-".
// THROWS: Error{kResource} if that cannot be written; then no file of this name appears.
void write_output(const std::string& path, const std::function<void(std::ostream&)>& write);

}  // namespace reeb::tools
