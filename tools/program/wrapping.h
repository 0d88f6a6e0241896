// Text for a terminal of 80 columns.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace reeb::tools {

inline constexpr std::size_t kTextColumns = 80;

// `text` with line ends in place of some spaces, so that each line has at most `columns` bytes, unless a word is
// longer. Further lines begin with `indent` spaces. Runs of spaces, as in tables, stay if the line does not break
// there.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t columns = kTextColumns);

// One line of a message to standard error, wrapped.
void print_line(std::string_view text, std::size_t indent = 4);

}  // namespace reeb::tools
