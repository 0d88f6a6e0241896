#include "tools/program/wrapping.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>

namespace reeb::tools {

std::string wrapped(std::string_view text, std::size_t indent, std::size_t columns) {
  std::string lines;
  std::size_t room = columns;
  while (text.size() > room) {
    const std::size_t first_word = std::min(text.find_first_not_of(' '), text.size());
    std::size_t end = text.rfind(' ', room);
    if (end == std::string_view::npos || end <= first_word) end = text.find(' ', first_word);
    if (end == std::string_view::npos) break;
    const std::size_t next = text.find_first_not_of(' ', end);
    if (next == std::string_view::npos) break;
    const std::string_view line = text.substr(0, end);
    lines.append(line.substr(0, line.find_last_not_of(' ') + 1)).append("\n").append(indent, ' ');
    text.remove_prefix(next);
    room = columns - std::min(indent, columns);
  }
  return lines.append(text);
}

void print_line(std::string_view text, std::size_t indent) { fmt::print(stderr, "{}\n", wrapped(text, indent)); }

}  // namespace reeb::tools
