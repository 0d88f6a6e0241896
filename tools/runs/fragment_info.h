// The output of `reeb info` for a fragment.
#pragma once

#include <string>

namespace reeb::tools {

// Prints which parts of which mesh are in it, what has settled and what is open, as text or JSON.
// THROWS: Error{kBadInput} if it is damaged.
void print_fragment_info(const std::string& path, bool json);

}  // namespace reeb::tools
