#include "io/text/text_position.h"

#include <algorithm>
#include <string_view>

#include "io/text/cursor.h"

namespace reeb::io {

std::string text_position(const ContentSource& content, std::uint64_t offset) {
  Cursor cursor(content.reopen());
  std::uint64_t line = 1, begin = 0;
  while (cursor.offset() < offset && cursor.ensure(1)) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(cursor.available(), offset - cursor.offset()));
    const std::string_view text(cursor.data(), count);
    line += static_cast<std::uint64_t>(std::ranges::count(text, '\n'));
    if (const std::size_t last = text.rfind('\n'); last != std::string_view::npos) begin = cursor.offset() + last + 1;
    cursor.advance(count);
  }
  return std::to_string(line) + ":" + std::to_string(offset - begin + 1);
}

}  // namespace reeb::io
