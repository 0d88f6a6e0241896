// The output of `reeb info` for a .reeb file.
#pragma once

#include <string>

namespace reeb::tools {

// Prints counts, function and level table to standard output, as text or JSON.
// THROWS: Error{kBadInput} with the location.
void print_reeb_info(const std::string& path, bool json);

}  // namespace reeb::tools
