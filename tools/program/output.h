// The destination of a command's result: a file that appears only when whole, or standard output.
#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace reeb::tools {

// THROWS: Error{kBadInput} if `path` exists and `force` is not given, or is a folder. Never throws for "" and "-".
void refuse_existing(const std::string& path, bool force);

// Calls `write` with the stream of `path`, or standard output for "" and "-".
// THROWS: Error{kResource} if writing fails; then no file of this name appears.
void write_output(const std::string& path, const std::function<void(std::ostream&)>& write);

}  // namespace reeb::tools
