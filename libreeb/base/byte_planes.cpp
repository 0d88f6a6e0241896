#include "libreeb/base/byte_planes.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

// The loops name each byte of a number. So the compiler sees interleaved bytes and shuffles many at once: half a
// nanosecond per number, where shifting takes two to four.

namespace reeb {

static_assert(std::endian::native == std::endian::little, "planes are the bytes of numbers as they lie in memory");

namespace {

// Numbers are split in tiles of fixed size, in which the compiler knows that planes do not overlap.
constexpr std::size_t kNumbersPerTile = 64;
template <class Word>
using WordTile = std::array<Word, kNumbersPerTile>;
template <class Word>
using PlaneTile = std::array<std::array<std::byte, kNumbersPerTile>, sizeof(Word)>;
template <class Word>
using ForEachByte = std::make_index_sequence<sizeof(Word)>;

template <class Word, std::size_t... B>
void split(const WordTile<Word>& numbers, PlaneTile<Word>& planes, std::index_sequence<B...> /*bytes*/) {
  const std::byte* from = std::as_bytes(std::span(numbers)).data();
  for (std::size_t i = 0; i < kNumbersPerTile; ++i) ((planes[B][i] = from[sizeof(Word) * i + B]), ...);
}

template <class Word>
void split_words(std::span<const Word> numbers, std::byte* planes) {
  const std::size_t count = numbers.size();
  WordTile<Word> words{};
  PlaneTile<Word> tile;
  for (std::size_t begin = 0; begin < count; begin += kNumbersPerTile) {
    const std::size_t size = std::min(kNumbersPerTile, count - begin);
    std::ranges::copy(numbers.subspan(begin, size), words.begin());
    split<Word>(words, tile, ForEachByte<Word>());
    for (std::size_t p = 0; p < tile.size(); ++p) std::memcpy(planes + p * count + begin, tile[p].data(), size);
  }
}

// By value, so that the compiler knows that no byte is written over the places of the planes.
template <class Word, std::size_t... B>
void join_words(const std::array<const std::byte*, sizeof(Word)> planes, std::span<Word> numbers,
                std::index_sequence<B...> /*bytes*/) {
  std::byte* __restrict to = std::as_writable_bytes(numbers).data();
  for (std::size_t i = 0; i < numbers.size(); ++i) ((to[sizeof(Word) * i + B] = planes[B][i]), ...);
}

}  // namespace

void split_planes(std::span<const std::uint64_t> numbers, std::byte* planes) { split_words(numbers, planes); }
void split_planes(std::span<const std::uint32_t> numbers, std::byte* planes) { split_words(numbers, planes); }

void join_planes(const std::array<const std::byte*, kBytePlanes>& planes, std::span<std::uint64_t> numbers) {
  join_words(planes, numbers, ForEachByte<std::uint64_t>());
}
void join_planes(const std::array<const std::byte*, kBytePlanes / 2>& planes, std::span<std::uint32_t> numbers) {
  join_words(planes, numbers, ForEachByte<std::uint32_t>());
}

}  // namespace reeb
