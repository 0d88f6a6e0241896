// The range coder of SMC files (after Martin 1979 and Schindler 1998), bytewise, with carry.
//
// Encoder and decoder have the same interface, so that the code that describes the file is written once: code(model,
// symbol) returns the symbol; the decoder ignores the argument.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>

#include "io/smc/adaptive_model.h"
#include "io/text/cursor.h"

namespace reeb::io {

// The largest alphabet of uniform numbers that is coded in one part; larger ones are coded in two.
inline constexpr std::uint32_t kMaxUniform = 4194303;

class RangeDecoder {
 public:
  static constexpr bool kDecodes = true;

  // THROWS: BAD_HEADER, TRUNCATED. The cursor must outlive the decoder.
  explicit RangeDecoder(Cursor& cursor);

  // A number less than `size`. REQUIRES: size > 0. THROWS: TRUNCATED, CORRUPT.
  std::uint32_t uniform(std::uint32_t size, std::uint32_t = 0) {
    if (size > kMaxUniform) [[unlikely]] {
      const std::uint32_t low_half = uniform(65536);
      const std::uint32_t number = low_half | (uniform((size >> 16) + 1) << 16);
      if (number >= size) fail_damaged();
      return number;
    }
    normalize();
    const std::uint32_t step = range_ / size;
    std::uint32_t symbol = low_ / step;
    if (symbol >= size) symbol = size - 1;
    low_ -= step * symbol;
    range_ = symbol + 1 < size ? step : range_ - step * symbol;
    if (low_ >= range_) [[unlikely]]
      fail_damaged();
    return symbol;
  }
  std::uint32_t word(std::uint32_t = 0) {
    const std::uint32_t low_half = uniform(65536);
    return low_half | (uniform(65536) << 16);
  }
  std::uint32_t code(AdaptiveModel& model, std::uint32_t = 0) {
    normalize();
    const std::uint32_t step = range_ >> model.bits(), end = 1u << model.bits();
    std::uint32_t place = low_ / step;
    if (place >= end) place = end - 1;
    const std::uint32_t symbol = model.find(place);
    const std::uint32_t below = model.below(symbol), above = model.below(symbol + 1);
    low_ -= step * below;
    range_ = above < end ? step * (above - below) : range_ - step * below;
    if (low_ >= range_) [[unlikely]]
      fail_damaged();
    model.update(symbol);
    return symbol;
  }

  // As code(), for a small model with two symbols: a comparison replaces division and search.
  bool bit(AdaptiveModel& model, bool = false) {
    normalize();
    const std::uint32_t first = (range_ >> kSmallModel.bits) * model.below(1);
    const bool symbol = low_ >= first;
    low_ -= symbol ? first : 0;
    range_ = symbol ? range_ - first : first;
    if (low_ >= range_) [[unlikely]]
      fail_damaged();
    model.update(symbol ? 1 : 0);
    return symbol;
  }

  // Call it after the last symbol. THROWS: TRUNCATED; CORRUPT if the stored length is wrong.
  void finish();

  std::uint64_t position() const { return cursor_.offset() + used_; }

 private:
  static constexpr std::uint32_t kBottom = 1u << 23;

  void normalize() {
    while (range_ <= kBottom) {
      low_ = (low_ << 8) | ((last_ << 7) & 0xFF);
      last_ = next_byte();
      low_ |= last_ >> 1;
      range_ <<= 8;
    }
  }
  std::uint32_t next_byte() {
    if (used_ == ready_) [[unlikely]]
      refill();
    return static_cast<unsigned char>(bytes_[used_++]);
  }
  void refill();
  [[noreturn]] void fail_damaged() const;

  Cursor& cursor_;
  std::uint64_t start_;
  const char* bytes_ = nullptr;  // at the cursor; used_ of them are consumed
  std::size_t used_ = 0, ready_ = 0;
  std::uint32_t tail_ = 0;  // the last bytes before those in bytes_
  std::uint32_t low_ = 0, range_ = 128, last_ = 0;
};

class RangeEncoder {
 public:
  static constexpr bool kDecodes = false;

  // The stream must outlive the encoder.
  explicit RangeEncoder(std::ostream& out) : out_(out) {}

  std::uint32_t uniform(std::uint32_t size, std::uint32_t symbol);
  std::uint32_t word(std::uint32_t value);
  std::uint32_t code(AdaptiveModel& model, std::uint32_t symbol);
  bool bit(AdaptiveModel& model, bool symbol) { return code(model, symbol ? 1 : 0) != 0; }
  // Writes the bytes that are held back, and the length of the stream.
  void finish();

 private:
  static constexpr std::uint32_t kTop = 1u << 31, kBottom = 1u << 23;

  void normalize();
  void put(std::uint32_t byte);
  void put_held(bool carry);
  void flush();

  std::ostream& out_;
  std::string buffer_;
  std::uint32_t low_ = 0, range_ = kTop;
  std::uint32_t held_ = 1;     // the oldest byte that a carry can still change
  std::uint64_t pending_ = 0;  // number of bytes 0xFF after it
  std::uint32_t shifts_ = 0;
};

}  // namespace reeb::io
