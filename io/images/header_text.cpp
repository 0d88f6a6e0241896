#include "io/images/header_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"

namespace reeb::io {

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> words;
  while (!(text = without_blanks(text)).empty()) {
    const auto length = static_cast<std::size_t>(std::ranges::find_if(text, is_blank) - text.begin());
    words.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return words;
}

bool HeaderText::next_line() {
  if (next_ == head_.size()) return false;
  const std::size_t end = std::min(head_.find('\n', next_), head_.size());
  line_ = head_.substr(next_, end - next_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  next_ = std::min(end + 1, head_.size());
  ++number_;
  return true;
}

double HeaderText::number(std::string_view word, const char* what) const {
  const auto parsed = parse_number<double>(word);
  if (!parsed.ok || !std::isfinite(parsed.value))
    fail(word, in_quotes(word) + " is not a finite number (" + what + ")", kHeaderHint);
  return parsed.value + 0.0;
}

std::int64_t HeaderText::integer(std::string_view word, const char* what) const {
  std::int64_t value = 0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
  if (parsed.ec == std::errc::result_out_of_range) fail(word, std::string("too large: ") + what, kHeaderHint);
  if (parsed.ec != std::errc{} || parsed.ptr != word.data() + word.size())
    fail(word, in_quotes(word) + " is not an integer (" + what + ")", kHeaderHint);
  return value;
}

std::uint64_t HeaderText::count(std::string_view word, const char* what) const {
  const std::int64_t value = integer(word, what);
  if (value < 0) fail(word, std::string("negative: ") + what, kHeaderHint);
  return static_cast<std::uint64_t>(value);
}

void HeaderText::fail(std::string_view part, const std::string& what, const std::string& hint) const {
  const bool inside = part.data() >= line_.data() && part.data() <= line_.data() + line_.size();
  const auto column = inside ? part.data() - line_.data() + 1 : 1;
  throw Error(ErrorKind::kBadInput, what, hint)
      .at(name_, std::to_string(std::max<std::uint64_t>(number_, 1)) + ":" + std::to_string(column));
}

}  // namespace reeb::io
