#include "ooc/column_codec.h"

#include "ooc/zstd_codec.h"

namespace reeb::ooc {

void ColumnEncoder::pack(std::vector<std::byte>& packed, int level) const {
  zstd_compress(planes_, level, packed);
}

ColumnDecoder::ColumnDecoder(std::span<const std::byte> packed, std::size_t columns,
                             std::size_t count)
    : planes_(8 * columns * count), count_(count), ok_(zstd_decompress(packed, planes_)) {}

}  // namespace reeb::ooc
