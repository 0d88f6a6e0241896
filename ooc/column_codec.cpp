#include "ooc/column_codec.h"

#include "ooc/zstd_codec.h"

namespace reeb::ooc {

void ColumnEncoder::add_planes() {
  const std::size_t count = column_.size(), before = bytes_.size();
  bytes_.resize(before + 8 * count);
  std::byte* plane = bytes_.data() + before;
  for (unsigned shift = 0; shift < 64; shift += 8, plane += count)
    for (std::size_t i = 0; i < count; ++i) plane[i] = static_cast<std::byte>(column_[i] >> shift);
}

void ColumnEncoder::pack(std::vector<std::byte>& packed, int level) const {
  zstd_compress(bytes_, level, packed);
}

ColumnDecoder::ColumnDecoder(std::span<const std::byte> packed, std::size_t columns, std::size_t count)
    : column_(count), tail_begin_(8 * columns * count) {
  constexpr std::size_t kMostTail = 1 << 28;  // far more than any block has
  const std::size_t size = zstd_content_size(packed);
  if (size < tail_begin_ || size - tail_begin_ > kMostTail) return;
  bytes_.resize(size);
  ok_ = zstd_decompress(packed, bytes_);
}

std::span<const std::uint64_t> ColumnDecoder::column(std::size_t column) {
  const std::size_t count = column_.size();
  const std::byte* plane = bytes_.data() + 8 * column * count;
  for (std::size_t i = 0; i < count; ++i) column_[i] = std::to_integer<std::uint64_t>(plane[i]);
  for (unsigned shift = 8; shift < 64; shift += 8) {
    plane += count;
    for (std::size_t i = 0; i < count; ++i) column_[i] |= std::to_integer<std::uint64_t>(plane[i]) << shift;
  }
  return column_;
}

}  // namespace reeb::ooc
