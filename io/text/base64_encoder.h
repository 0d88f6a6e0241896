// Bytes as base64, as they come.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace reeb::io {

// Calls write(std::string_view) with four characters at a time.
template <class Write>
class Base64Encoder {
 public:
  explicit Base64Encoder(Write write) : write_(std::move(write)) {}

  void put(std::string_view bytes) {
    for (const char byte : bytes) put(static_cast<std::uint8_t>(byte));
  }
  void put(std::uint8_t byte) {
    group_ = group_ << 8 | byte;
    if (++held_ == kGroup) write_group(kGroup);
  }

  // Call once, after all bytes.
  void finish() {
    if (held_ == 0) return;
    group_ <<= 8 * (kGroup - held_);
    write_group(held_);
  }

 private:
  static constexpr std::size_t kGroup = 3;

  void write_group(std::size_t bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<char, kGroup + 1> digits;
    for (std::size_t i = 0; i < digits.size(); ++i) digits[i] = i <= bytes ? kDigits[group_ >> (18 - 6 * i) & 63] : '=';
    write_(std::string_view(digits.data(), digits.size()));
    group_ = 0;
    held_ = 0;
  }

  Write write_;
  std::uint32_t group_ = 0;
  std::size_t held_ = 0;  // bytes in the group
};

}  // namespace reeb::io
