// Counts as messages print them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace reeb {

// "1,234,567".
std::string with_commas(std::uint64_t count);

// "1 loop", "2 loops", "1,234 vertices": the noun follows the count. Nouns that end in "ex" get "ices", in "is" "es",
// in "ry" "ries", others an s.
std::string count_of(std::uint64_t count, std::string_view noun);

}  // namespace reeb
