#include "libreeb/base/printable.h"

#include <algorithm>
#include <cstddef>

namespace reeb {
namespace {

bool is_between(char c, unsigned low, unsigned high) {
  const unsigned byte = static_cast<unsigned char>(c);
  return low <= byte && byte <= high;
}

// The bytes of the character that `text` begins with, if it may be shown; else 0.
std::size_t shown_bytes(std::string_view text) {
  const unsigned first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  // The second byte has fewer values where more would be another way to write a shorter character, a surrogate, a
  // number beyond Unicode, or (from C2 80 to C2 9F) a control character.
  std::size_t size = 0;
  unsigned low = 0x80, high = 0xbf;
  if (first >= 0xc2 && first <= 0xdf) {
    size = 2;
    if (first == 0xc2) low = 0xa0;
  } else if (first >= 0xe0 && first <= 0xef) {
    size = 3;
    if (first == 0xe0) low = 0xa0;
    if (first == 0xed) high = 0x9f;
  } else if (first >= 0xf0 && first <= 0xf4) {
    size = 4;
    if (first == 0xf0) low = 0x90;
    if (first == 0xf4) high = 0x8f;
  }
  if (size == 0 || text.size() < size || !is_between(text[1], low, high)) return 0;
  const std::string_view rest = text.substr(2, size - 2);
  return std::ranges::all_of(rest, [](char c) { return is_between(c, 0x80, 0xbf); }) ? size : 0;
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const std::size_t size = shown_bytes(text);
    if (size == 0) {
      const unsigned byte = static_cast<unsigned char>(text[0]);
      shown += "\\x";
      shown += kDigits[byte >> 4];
      shown += kDigits[byte & 15];
    }
    shown += text.substr(0, size);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return shown;
}

}  // namespace reeb
