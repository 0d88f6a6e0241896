// The name that a user may have meant.
#pragma once

#include <string>
#include <vector>

namespace reeb {

// The one of `names` that differs least from `word`; empty if none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& names);

}  // namespace reeb
