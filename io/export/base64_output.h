// Bytes as base64, as they come.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/text/output_buffer.h"

namespace reeb::io {

class Base64Output {
 public:
  explicit Base64Output(OutputBuffer& out) : out_(out) {}

  // Little endian.
  void put(std::uint32_t word) {
    for (unsigned shift = 0; shift < 32; shift += 8) put_byte(word >> shift & 0xFF);
  }
  void put(float number) { put(std::bit_cast<std::uint32_t>(number)); }

  // Call once, after all bytes.
  void finish() {
    const std::size_t bytes = held_;
    if (bytes == 0) return;
    while (held_ != 0) put_byte(0);
    for (std::size_t i = bytes; i < 3; ++i) out_.text()[out_.text().size() - 3 + i] = '=';
  }

 private:
  void put_byte(std::uint32_t byte) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    group_ = group_ << 8 | byte;
    if (++held_ < 3) return;
    // Whole groups are written at once, so that finish() finds the last one in the buffer.
    std::array<char, 4> digits;
    for (std::size_t i = 0; i < 4; ++i) digits[i] = kDigits[group_ >> (18 - 6 * i) & 63];
    out_.flush_if_full();
    out_.text().append(digits.data(), digits.size());
    group_ = 0;
    held_ = 0;
  }

  OutputBuffer& out_;
  std::uint32_t group_ = 0;
  std::size_t held_ = 0;  // bytes in the group
};

}  // namespace reeb::io
