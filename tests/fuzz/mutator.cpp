#include "tests/fuzz/mutator.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace reeb::test {
namespace {

constexpr std::array<std::string_view, 31> kNumbers = {"0",
                                                       "1",
                                                       "-1",
                                                       "2",
                                                       "3",
                                                       "4",
                                                       "-2",
                                                       "-3",
                                                       "255",
                                                       "256",
                                                       "65536",
                                                       "2147483647",
                                                       "2147483648",
                                                       "-2147483648",
                                                       "4294967295",
                                                       "4294967296",
                                                       "9223372036854775807",
                                                       "18446744073709551615",
                                                       "99999999999999999999",
                                                       "1e400",
                                                       "-1e-400",
                                                       "3.5e38",
                                                       "nan",
                                                       "-inf",
                                                       "0x1p-149",
                                                       "1.5",
                                                       ".",
                                                       "-",
                                                       "+7",
                                                       "",
                                                       "1e"};

const std::array<std::uint64_t, 16> kFields = {0,
                                               1,
                                               2,
                                               3,
                                               ~0ULL,
                                               ~0ULL - 1,
                                               0x7f,
                                               0x80,
                                               0xffff,
                                               0x7fffffff,
                                               0x80000000,
                                               1ULL << 32,
                                               1ULL << 62,
                                               std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()),
                                               std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()),
                                               std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity())};

bool is_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '.' || c == 'e'; }

}  // namespace

Mutator::Mutator(const FuzzTarget& target, std::uint64_t seed)
    : target_(target), random_(seed), corpus_(target.corpus()) {
  for (std::string& sample : corpus_)
    if (sample.size() > kMaxBytes) sample.resize(kMaxBytes);
}

std::string Mutator::next() {
  std::string bytes = sample();
  mutate(bytes);
  return bytes;
}

void Mutator::mutate(std::string& bytes) {
  std::uint64_t changes = 1;
  while (changes < 8 && random_.chance(50)) ++changes;
  while (changes-- > 0) change_once(bytes);
  if (bytes.size() > kMaxBytes) bytes.resize(kMaxBytes);
  if (target_.fix_checksums != nullptr && !random_.chance(10)) target_.fix_checksums(bytes);
}

std::size_t Mutator::place(const std::string& bytes) {
  const std::size_t all = bytes.size() + 1;
  return random_.below(random_.chance(40) ? std::min<std::size_t>(all, 256) : all);
}

void Mutator::change_once(std::string& bytes) {
  const std::size_t at = place(bytes);
  switch (random_.below(12)) {
    case 0:
      if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << random_.below(8)));
      return;
    case 1:
      if (at < bytes.size()) bytes[at] = static_cast<char>(random_.next());
      return;
    case 2:
      bytes.erase(at, random_.below(40));
      return;
    case 3:
      bytes.insert(at, bytes.substr(at, random_.below(60)));
      return;
    case 4:
      bytes.resize(random_.below(bytes.size() + 1));
      return;
    case 5:
      return splice(bytes);
    case 6:
    case 7:
      return overwrite_field(bytes);
    case 8:
    case 9:
      return overwrite_number(bytes);
    case 10:
      return change_line(bytes);
    default:
      if (!target_.words.empty())
        bytes.insert(at, std::string(target_.words[random_.below(target_.words.size())]) + " \n"[random_.below(2)]);
      return;
  }
}

// Overwrites a field of 1, 2, 4 or 8 bytes, in either byte order.
void Mutator::overwrite_field(std::string& bytes) {
  const std::size_t at = place(bytes), width = std::size_t{1} << random_.below(4);
  if (at + width > bytes.size()) return;
  std::uint64_t value = kFields[random_.below(kFields.size())];
  if (random_.chance(30)) value = random_.below(64);
  std::array<char, 8> field;
  std::memcpy(field.data(), &value, sizeof value);
  if (random_.chance(50)) std::reverse(field.begin(), field.begin() + static_cast<std::ptrdiff_t>(width));
  std::memcpy(bytes.data() + at, field.data(), width);
}

// Overwrites the number at or after some position of a text.
void Mutator::overwrite_number(std::string& bytes) {
  const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(place(bytes));
  const auto begin = std::find_if(from, bytes.end(), is_number);
  const auto end = std::find_if_not(begin, bytes.end(), is_number);
  if (begin != end) bytes.replace(begin, end, kNumbers[random_.below(kNumbers.size())]);
}

// Removes, doubles, breaks or moves a line.
void Mutator::change_line(std::string& bytes) {
  const std::size_t at = place(bytes);
  const std::size_t begin = at == 0 ? 0 : bytes.rfind('\n', at - 1) + 1;
  const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
  if (begin >= end) return;
  const std::string line = bytes.substr(begin, std::min(end + 1, bytes.size()) - begin);
  switch (random_.below(4)) {
    case 0:
      bytes.erase(begin, line.size());
      return;
    case 1:
      bytes.insert(begin, line);
      return;
    case 2:
      bytes.insert(begin + random_.below(line.size()), "\n");
      return;
    default:
      bytes.erase(begin, line.size());
      bytes.insert(std::min(place(bytes), bytes.size()), line);
      return;
  }
}

// Joins the beginning of this file and the end of another, or inserts a part of another.
void Mutator::splice(std::string& bytes) {
  const std::string& other = sample();
  const std::size_t from = random_.below(other.size() + 1), at = place(bytes);
  if (random_.chance(50))
    bytes.replace(at, std::string::npos, other, from, std::string::npos);
  else
    bytes.insert(at, other, from, random_.below(200));
}

}  // namespace reeb::test
