// Little-endian numbers, varints and byte planes on byte vectors and spans. Every binary file of this project is
// written in them (docs/FORMAT.md, Numbers).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libreeb/base/byte_planes.h"

namespace reeb {

// Maps a difference modulo 2^64, or a signed number in two's complement, such that small magnitudes of either sign
// become small numbers: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
constexpr std::uint64_t zigzag(std::uint64_t difference) noexcept { return difference << 1 ^ (0 - (difference >> 63)); }
constexpr std::uint64_t unzigzag(std::uint64_t code) noexcept { return code >> 1 ^ (0 - (code & 1)); }
// The difference a - b modulo 2^64, zigzagged: exact for every pair of numbers.
constexpr std::uint64_t delta_code(std::uint64_t a, std::uint64_t b) noexcept { return zigzag(a - b); }

// LEB128: seven bits per byte, lowest first; the high bit is set on all but the last byte.
inline constexpr std::size_t kMaxVarintBytes = 10;
// Writes at most kMaxVarintBytes, and returns their end.
inline std::byte* put_varint(std::byte* to, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) *to++ = static_cast<std::byte>(value | 0x80);
  *to++ = static_cast<std::byte>(value);
  return to;
}

// Appends to a vector that the caller owns.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::byte>& out) : out_(out) {}

  void u8(std::uint8_t value) { out_.push_back(static_cast<std::byte>(value)); }
  void u32(std::uint32_t value) { fixed(value, 4); }
  void u64(std::uint64_t value) { fixed(value, 8); }
  void f64(double value) { u64(std::bit_cast<std::uint64_t>(value)); }

  void varint(std::uint64_t value) {
    std::array<std::byte, kMaxVarintBytes> bytes;
    out_.insert(out_.end(), bytes.data(), put_varint(bytes.data(), value));
  }
  // The varints of value(0), value(1), ... value(count - 1), which are called in this order.
  template <class Value>
  void varints(std::size_t count, Value value) {
    constexpr std::size_t kAtOnce = 64;
    std::array<std::byte, kAtOnce * kMaxVarintBytes> some;
    for (std::size_t i = 0; i < count;) {
      std::byte* to = some.data();
      for (const std::size_t end = std::min(count, i + kAtOnce); i < end; ++i) to = put_varint(to, value(i));
      out_.insert(out_.end(), some.data(), to);
    }
  }
  // The delta of number(0) from 0, and of each later number from the one before.
  template <class Number>
  void deltas(std::size_t count, const Number& number) {
    varints(count, [&number, before = std::uint64_t{0}](std::size_t i) mutable {
      const std::uint64_t now = number(i);
      return delta_code(now, std::exchange(before, now));
    });
  }
  void delta(std::uint64_t a, std::uint64_t b) { varint(delta_code(a, b)); }

  void text(std::string_view value) {
    for (const char c : value) u8(static_cast<std::uint8_t>(c));
  }
  void bytes(std::span<const std::byte> value) { out_.insert(out_.end(), value.begin(), value.end()); }

  // All lowest bytes, then all second bytes, and so on. This puts equal bytes next to each other.
  void planes(std::span<const std::uint64_t> values) {
    const std::size_t before = out_.size();
    out_.resize(before + values.size_bytes());
    split_planes(values, out_.data() + before);
  }

 private:
  void fixed(std::uint64_t value, unsigned count) {
    for (unsigned i = 0; i < count; ++i) u8(static_cast<std::uint8_t>(value >> (8 * i)));
  }

  std::vector<std::byte>& out_;
};

// Reads a span from front to back. After a read past its end, or a varint of more than 64 bits, ok() stays false
// and every read yields zeros. So a decoder needs to check only once, at its end.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  bool ok() const { return ok_; }
  bool done() const { return ok_ && rest_.empty(); }
  std::size_t remaining() const { return rest_.size(); }
  void fail() {
    ok_ = false;
    rest_ = {};
  }

  std::uint8_t u8() { return static_cast<std::uint8_t>(fixed(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(fixed(4)); }
  std::uint64_t u64() { return fixed(8); }
  double f64() { return std::bit_cast<double>(u64()); }

  std::uint64_t varint() {
    // Most have one byte.
    if (!rest_.empty() && std::to_integer<unsigned>(rest_[0]) < 0x80) {
      const auto value = std::to_integer<std::uint64_t>(rest_[0]);
      rest_ = rest_.subspan(1);
      return value;
    }
    std::uint64_t value = 0;
    unsigned shift = 0;
    for (std::size_t i = 0; i < rest_.size() && shift < 64; shift += 7) {
      const auto byte = std::to_integer<std::uint64_t>(rest_[i++]);
      if (shift == 63 && byte > 1) break;
      value |= (byte & 0x7f) << shift;
      if ((byte & 0x80) != 0) continue;
      rest_ = rest_.subspan(i);
      return value;
    }
    fail();
    return 0;
  }
  // The inverse of ByteWriter::delta.
  std::uint64_t delta(std::uint64_t base) { return base + unzigzag(varint()); }
  // A varint that must fit in 32 bits.
  std::uint32_t varint32() {
    const std::uint64_t value = varint();
    if (value >> 32 != 0) fail();
    return static_cast<std::uint32_t>(value);
  }

  std::string text(std::size_t size) {
    const auto part = take(size);
    return {reinterpret_cast<const char*>(part.data()), part.size()};
  }

  // The next `size` bytes; none, and ok() is false, if fewer remain.
  std::span<const std::byte> bytes(std::size_t size) { return take(size); }

  // Fills `values`, which the caller has sized after may_hold().
  void planes(std::span<std::uint64_t> values) {
    const auto part = take(values.size_bytes());
    if (part.empty()) return;
    std::array<const std::byte*, kBytePlanes> planes;
    for (std::size_t p = 0; p < kBytePlanes; ++p) planes[p] = part.data() + p * values.size();
    join_planes(planes, values);
  }

  // Whether `count` items of at least `item_bytes` each can still follow. Call it before sizing anything by a count
  // that was read from the bytes.
  bool may_hold(std::uint64_t count, std::size_t item_bytes) {
    if (count > rest_.size() / item_bytes) fail();
    return ok_;
  }

 private:
  std::span<const std::byte> take(std::size_t size) {
    if (size > rest_.size()) fail();
    if (!ok_) return {};
    const auto part = rest_.first(size);
    rest_ = rest_.subspan(size);
    return part;
  }
  std::uint64_t fixed(std::size_t count) {
    std::uint64_t value = 0;
    unsigned shift = 0;
    for (const std::byte byte : take(count)) {
      value |= std::to_integer<std::uint64_t>(byte) << shift;
      shift += 8;
    }
    return value;
  }

  std::span<const std::byte> rest_;
  bool ok_ = true;
};

}  // namespace reeb
