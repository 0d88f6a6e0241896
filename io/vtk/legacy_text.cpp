#include "io/vtk/legacy_text.h"

#include <algorithm>
#include <cstring>

#include "io/text/text_cursor.h"
#include "io/text/text_position.h"
#include "io/text/words.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::uint64_t kMostNumbers = std::uint64_t{1} << 56;
constexpr std::size_t kLineBytes = 4096, kKeywordBytes = 32;

std::string_view first_word(std::string_view text) {
  return text.substr(0, static_cast<std::size_t>(std::ranges::find_if(text, is_blank_or_line_end) - text.begin()));
}

}  // namespace

std::string LegacyText::word() {
  while (cursor_.ensure(1) && is_blank_or_line_end(*cursor_.data())) cursor_.advance(1);
  mark_ = cursor_.offset();
  cursor_.ensure(kLineBytes);
  const std::string_view found = first_word({cursor_.data(), std::min(cursor_.available(), kLineBytes)});
  if (found.size() == kLineBytes) fail("a word of more than 4096 characters");
  cursor_.advance(found.size());
  return std::string(found);
}

std::uint64_t LegacyText::number(const char* what) {
  const std::string text = word();
  const auto value = whole_number<std::uint64_t>(text);
  if (!value || *value > kMostNumbers) fail(std::string("a ") + what + " cannot be " + in_quotes(text));
  return *value;
}

std::string LegacyText::peek_word() {
  cursor_.ensure(kKeywordBytes);
  return upper_case(first_word({cursor_.data(), std::min(cursor_.available(), kKeywordBytes)}));
}

bool LegacyText::more_on_line() {
  while (cursor_.ensure(1) && is_blank(*cursor_.data())) cursor_.advance(1);
  return cursor_.ensure(1) && *cursor_.data() != '\n';
}

void LegacyText::end_line() {
  while (cursor_.ensure(1)) {
    const void* const found = std::memchr(cursor_.data(), '\n', cursor_.available());
    cursor_.advance(found == nullptr ? cursor_.available()
                                     : static_cast<std::size_t>(static_cast<const char*>(found) - cursor_.data()) + 1);
    if (found != nullptr) return;
  }
}

std::string LegacyText::line() {
  mark_ = cursor_.offset();
  cursor_.ensure(kLineBytes);
  const std::string_view text(cursor_.data(), std::min(cursor_.available(), kLineBytes));
  std::string found(text.substr(0, text.find('\n')));
  end_line();
  return found;
}

void LegacyText::skip_bytes(std::uint64_t count) {
  const std::uint64_t end = cursor_.offset() + count;
  if (content_.size().value_or(end) < end)
    fail("the file announces " + count_of(count, "byte") + " here, more than it has room for");
  cursor_.move_forward(end);
  if (cursor_.offset() < end) fail_end();
}

void LegacyText::skip_words(std::uint64_t count) {
  if (count > most_numbers(content_, cursor_.offset()))
    fail("the file announces " + count_of(count, "number") + " here, more than it has room for");
  bool in_word = false;
  while (true) {
    if (!cursor_.ensure(1)) {
      if (count > (in_word ? 1 : 0)) fail_end();
      return;
    }
    const char* const begin = cursor_.data();
    const char* const end = begin + cursor_.available();
    const char* next = begin;
    for (; next != end; ++next) {
      const bool separator = is_blank_or_line_end(*next);
      if (in_word && separator && --count == 0) break;
      if (count == 0) break;
      in_word = !separator;
    }
    cursor_.advance(static_cast<std::size_t>(next - begin));
    if (count == 0) return;
  }
}

// Of text, one a line; in binary, the length of each is before it, in a form of its own.
void LegacyText::skip_strings(std::uint64_t count) {
  for (; count != 0; --count) {
    if (!cursor_.ensure(1)) fail_end();
    if (!binary_) {
      end_line();
      continue;
    }
    const auto first = static_cast<unsigned char>(*cursor_.data());
    const std::size_t bytes = std::size_t{1} << (3 - (first >> 6));
    if (!cursor_.ensure(bytes)) fail_end();
    std::uint64_t length = first & 63;
    for (std::size_t i = 1; i < bytes; ++i)
      length = (length & (kMostNumbers - 1)) << 8 | static_cast<unsigned char>(cursor_.data()[i]);
    cursor_.advance(bytes);
    skip_bytes(length);
  }
}

std::uint64_t LegacyText::product(std::uint64_t a, std::uint64_t b) const {
  if (b != 0 && a > kMostNumbers / b) fail("the file announces an array of an impossible size");
  return a * b;
}

void LegacyText::fail(const std::string& what, const std::string& hint) const {
  throw Error(ErrorKind::kBadInput, what, hint)
      .at(content_.name(), binary_ ? std::to_string(mark_) : text_position(content_, mark_));
}

void LegacyText::fail_end() {
  mark_ = cursor_.offset() + cursor_.available();
  fail("the file ends before its last array");
}

}  // namespace reeb::io
