// Collects text and bytes, and passes them to a stream in large blocks.
#pragma once

#include <bit>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

#include "io/text/number_text.h"

namespace reeb::io {

// A number to be written with as few digits as restore it.
struct Shortest {
  double value;
};

class OutputBuffer {
 public:
  // REQUIRES: `out` throws if it cannot write, as FileOstream does.
  explicit OutputBuffer(std::ostream& out) : out_(out) { text_.reserve(kFlushBytes + 4096); }
  OutputBuffer(const OutputBuffer&) = delete;
  OutputBuffer& operator=(const OutputBuffer&) = delete;

  OutputBuffer& operator<<(std::string_view text) {
    text_ += text;
    flush_if_full();
    return *this;
  }
  OutputBuffer& operator<<(char c) { return *this << std::string_view(&c, 1); }
  OutputBuffer& operator<<(double value) {
    append_double(text_, value);
    return *this;
  }
  OutputBuffer& operator<<(Shortest number) {
    append_shortest(text_, number.value);
    return *this;
  }
  OutputBuffer& operator<<(std::integral auto value) {
    char digits[24];
    const auto result = std::to_chars(digits, digits + sizeof digits, value);
    return *this << std::string_view(digits, static_cast<std::size_t>(result.ptr - digits));
  }

  // For callers that append by themselves; they must call flush_if_full() now and then.
  std::string& text() { return text_; }
  void append_word(std::uint32_t word) {  // little endian
    for (unsigned shift = 0; shift < 32; shift += 8) text_.push_back(static_cast<char>((word >> shift) & 0xFF));
  }
  void append_float(float value) { append_word(std::bit_cast<std::uint32_t>(value)); }

  void flush_if_full() {
    if (text_.size() >= kFlushBytes) flush();
  }
  // The destructor does not flush, since an error of the stream must not be lost.
  void flush() {
    out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }
  std::ostream& stream() { return out_; }

 private:
  static constexpr std::size_t kFlushBytes = 1 << 16;
  std::ostream& out_;
  std::string text_;
};

}  // namespace reeb::io
