// Collects text and hands it to a stream in large pieces.
#pragma once

#include <charconv>
#include <concepts>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

#include "io/text/number_text.h"

namespace reeb::io {

class TextSink {
 public:
  explicit TextSink(std::ostream& out) : out_(out) { text_.reserve(kFlushBytes + 4096); }
  TextSink(const TextSink&) = delete;
  TextSink& operator=(const TextSink&) = delete;

  TextSink& operator<<(std::string_view text) {
    text_ += text;
    if (text_.size() >= kFlushBytes) flush();
    return *this;
  }
  TextSink& operator<<(char c) { return *this << std::string_view(&c, 1); }
  TextSink& operator<<(double value) {
    append_double(text_, value);
    return *this;
  }
  TextSink& operator<<(std::integral auto value) {
    char digits[24];
    const auto result = std::to_chars(digits, digits + sizeof digits, value);
    return *this << std::string_view(digits, static_cast<std::size_t>(result.ptr - digits));
  }

  // Not done by a destructor: an error of the stream has to be seen.
  void flush() {
    out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

 private:
  static constexpr std::size_t kFlushBytes = 1 << 16;
  std::ostream& out_;
  std::string text_;
};

}  // namespace reeb::io
