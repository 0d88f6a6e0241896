#include "ooc/sorting/column_codec.h"

#include <array>
#include <bit>
#include <cstring>

#include "io/file/zstd_codec.h"
#include "libreeb/base/byte_planes.h"

namespace reeb::ooc {

void ColumnEncoder::add_planes() {
  const std::size_t count = column_.size(), before = bytes_.size();
  std::uint64_t all = 0;
  for (const std::uint64_t code : column_) all |= code;
  bytes_.resize(before + 1 + kBytePlanes * count);
  std::byte *first = bytes_.data() + before + 1, *end = first;
  split_planes(column_, first);
  unsigned planes = 0;
  for (unsigned p = 0; p < kBytePlanes; ++p) {
    if ((all >> 8 * p & 0xff) == 0) continue;
    planes |= 1u << p;
    std::memmove(end, first + p * count, count);
    end += count;
  }
  bytes_[before] = static_cast<std::byte>(planes);
  bytes_.resize(static_cast<std::size_t>(end - bytes_.data()));
}

void ColumnEncoder::pack(std::vector<std::byte>& packed, int level) {
  thread_local io::ZstdCompressor compressor;
  compressor.compress(bytes_, level, packed);
  bytes_.clear();
}

ColumnDecoder::ColumnDecoder(std::span<const std::byte> packed, std::size_t columns, std::size_t count)
    : column_(count), zeros_(count), begin_(columns) {
  const std::size_t frame = io::zstd_frame_size(packed), size = io::zstd_content_size(packed);
  if (frame == 0 || size > columns * (1 + kBytePlanes * count)) return;
  memory_ = std::make_unique_for_overwrite<std::byte[]>(size);
  bytes_ = {memory_.get(), size};
  tail_ = packed.subspan(frame);
  ok_ = io::zstd_decompress(packed.first(frame), bytes_) && find_columns();
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
  const auto present = std::to_integer<unsigned>(bytes_[begin_[column]]);
  const std::byte* plane = bytes_.data() + begin_[column] + 1;
  std::array<const std::byte*, kBytePlanes> planes;
  for (unsigned p = 0; p < kBytePlanes; ++p) {
    const bool is_present = (present >> p & 1) != 0;
    planes[p] = is_present ? plane : zeros_.data();
    if (is_present) plane += count;
  }
  join_planes(planes, column_);
  return column_;
}

}  // namespace reeb::ooc
