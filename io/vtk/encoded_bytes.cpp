#include "io/vtk/encoded_bytes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::uint8_t kBlank = 64, kPadding = 65, kEnd = 66;

constexpr std::array<std::uint8_t, 256> make_digits() {
  std::array<std::uint8_t, 256> digits{};
  digits.fill(kEnd);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    digits[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  for (const char blank : {' ', '\t', '\r', '\n'}) digits[static_cast<unsigned char>(blank)] = kBlank;
  digits[static_cast<unsigned char>('=')] = kPadding;
  return digits;
}
constexpr std::array<std::uint8_t, 256> kDigitOf = make_digits();

}  // namespace

void move_forward(Cursor& cursor, std::uint64_t offset) {
  if (cursor.source().can_seek()) return cursor.move_to(offset);
  while (cursor.offset() < offset && cursor.ensure(1))
    cursor.advance(static_cast<std::size_t>(std::min<std::uint64_t>(cursor.available(), offset - cursor.offset())));
}

EncodedBytes::EncodedBytes(std::unique_ptr<ContentSource> source, std::uint64_t offset, bool base64)
    : cursor_(std::move(source)), base64_(base64) {
  move_forward(cursor_, offset);
}

std::size_t EncodedBytes::read(char* out, std::size_t limit) {
  if (!base64_) return read_raw(out, limit);
  std::size_t done = 0;
  while (done < limit) {
    if (triple_taken_ == triple_size_) {
      triple_taken_ = 0;
      triple_size_ = decode();
      if (triple_size_ == 0) break;
    }
    while (done < limit && triple_taken_ < triple_size_) out[done++] = triple_[triple_taken_++];
  }
  return done;
}

std::size_t EncodedBytes::read_raw(char* out, std::size_t limit) {
  if (!cursor_.ensure(1)) return 0;
  const std::size_t count = std::min(limit, cursor_.available());
  std::memcpy(out, cursor_.data(), count);
  cursor_.advance(count);
  return count;
}

// Decodes four digits. Padding can stand in the middle of an array, after its header; then the next digits begin a new
// text.
std::size_t EncodedBytes::decode() {
  std::uint32_t bits = 0;
  unsigned digits = 0, padding = 0;
  while (digits + padding < 4) {
    const std::uint8_t digit = cursor_.ensure(1) ? kDigitOf[static_cast<unsigned char>(*cursor_.data())] : kEnd;
    if (digit == kEnd && digits + padding == 0) return 0;
    const bool misplaced = digit == kPadding ? digits < 2 : digit < kBlank && padding != 0;
    if (digit == kEnd || misplaced)
      throw Error(ErrorKind::kBadInput, "the base64 text of an array is damaged or cut",
                  "the file is damaged here; get a whole copy")
          .at(cursor_.source().name(), std::to_string(cursor_.offset()));
    cursor_.advance(1);
    if (digit == kBlank) continue;
    if (digit == kPadding) {
      ++padding;
      continue;
    }
    bits = bits << 6 | digit;
    ++digits;
  }
  bits <<= 6 * padding;
  for (unsigned i = 0; i < 3; ++i) triple_[i] = static_cast<char>(bits >> (16 - 8 * i) & 0xFF);
  return 3 - padding;
}

}  // namespace reeb::io
