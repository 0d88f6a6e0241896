#include "io/text/number_text.h"

#include <array>
#include <charconv>

namespace reeb::io {

void append_double(std::string& out, double value) {
  std::array<char, 40> text;
  const auto result =
      std::to_chars(text.data(), text.data() + text.size(), value + 0.0, std::chars_format::general, 17);
  out.append(text.data(), result.ptr);
}

}  // namespace reeb::io
