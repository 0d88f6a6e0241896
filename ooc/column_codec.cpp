#include "ooc/column_codec.h"

#include <bit>

#include "ooc/zstd_codec.h"

namespace reeb::ooc {

void ColumnEncoder::add_planes() {
  const std::size_t count = column_.size(), before = bytes_.size();
  std::uint64_t all = 0;
  for (const std::uint64_t code : column_) all |= code;
  unsigned planes = 0;
  for (unsigned p = 0; p < 8; ++p) planes |= (all >> 8 * p & 0xff) != 0 ? 1u << p : 0;
  bytes_.resize(before + 1 + static_cast<std::size_t>(std::popcount(planes)) * count);
  bytes_[before] = static_cast<std::byte>(planes);
  std::byte* plane = bytes_.data() + before + 1;
  for (unsigned p = 0; p < 8; ++p) {
    if ((planes >> p & 1) == 0) continue;
    for (std::size_t i = 0; i < count; ++i) plane[i] = static_cast<std::byte>(column_[i] >> 8 * p);
    plane += count;
  }
}

void ColumnEncoder::pack(std::vector<std::byte>& packed, int level) const {
  thread_local ZstdCompressor compressor;
  compressor.compress(bytes_, level, packed);
}

ColumnDecoder::ColumnDecoder(std::span<const std::byte> packed, std::size_t columns, std::size_t count)
    : column_(count), begin_(columns) {
  const std::size_t frame = zstd_frame_size(packed), size = zstd_content_size(packed);
  if (frame == 0 || size > columns * (1 + 8 * count)) return;
  bytes_.resize(size);
  tail_ = packed.subspan(frame);
  ok_ = zstd_decompress(packed.first(frame), bytes_) && find_columns();
}

bool ColumnDecoder::find_columns() {
  std::size_t begin = 0;
  for (std::size_t& column_begin : begin_) {
    if (begin >= bytes_.size()) return false;
    column_begin = begin;
    begin += 1 + static_cast<std::size_t>(std::popcount(std::to_integer<unsigned>(bytes_[begin]))) * column_.size();
  }
  return begin == bytes_.size();
}

std::span<const std::uint64_t> ColumnDecoder::column(std::size_t column) {
  const std::size_t count = column_.size();
  const auto planes = std::to_integer<unsigned>(bytes_[begin_[column]]);
  const std::byte* plane = bytes_.data() + begin_[column] + 1;
  column_.assign(count, 0);
  for (unsigned p = 0; p < 8; ++p) {
    if ((planes >> p & 1) == 0) continue;
    for (std::size_t i = 0; i < count; ++i) column_[i] |= std::to_integer<std::uint64_t>(plane[i]) << 8 * p;
    plane += count;
  }
  return column_;
}

}  // namespace reeb::ooc
