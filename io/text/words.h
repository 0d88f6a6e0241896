// Words of a text, as readers compare and show them.
#pragma once

#include <string>
#include <string_view>

namespace reeb::io {

// The word as messages show it: its first 40 characters, in quotes.
std::string quoted(std::string_view word);
// Of the letters A to Z alone; other characters stay.
std::string lower_case(std::string_view text);
std::string upper_case(std::string_view text);

}  // namespace reeb::io
