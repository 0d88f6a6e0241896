// The destination of a command's result: a file that appears only when whole, or standard output.
#pragma once

#include <functional>
#include <initializer_list>
#include <ostream>
#include <string>
#include <string_view>

#include "io/file/atomic_file.h"

namespace reeb::tools {

// What --force says of outputs that exist before any work, and of those that appear during the work.
inline io::Existing existing_outputs(bool force) { return force ? io::Existing::kReplace : io::Existing::kRefuse; }
inline io::Existing late_outputs(bool force) { return force ? io::Existing::kReplace : io::Existing::kKeep; }

// Calls `write` with the stream of `path`, or of standard output for "" and "-".
// THROWS: as AtomicFile.
void write_output(const std::string& path, bool force, const std::function<void(std::ostream&)>& write);

// Prints what a written output is, as "an HTML page", if its name ends in another suffix than these; a name without
// one, and standard output, may be anything.
void note_other_suffix(const std::string& path, std::initializer_list<std::string_view> suffixes, const char* what);

}  // namespace reeb::tools
