#include "io/vtk/array_bytes.h"

#include <lz4.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// No more than this many bytes come of one packed byte, and no more than this many of nothing.
constexpr std::uint64_t kMostUnpacked = 1032, kLeastUnpacked = 4096;
constexpr std::uint64_t kMostBlockBytes = std::numeric_limits<int>::max();

}  // namespace

ArrayBytes::ArrayBytes(std::unique_ptr<ContentSource> source, const NumberPlace& place)
    : bytes_(std::move(source), place.offset, place.coding == NumberCoding::kBase64), place_(place) {
  left_ = std::numeric_limits<std::uint64_t>::max();
  if (!place_.has_header) return;
  if (place_.packing == BlockPacking::kNone)
    size_ = left_ = header_number();
  else
    read_block_sizes();
}

std::uint64_t ArrayBytes::header_number() {
  char bytes[8];
  const std::size_t size = place_.wide_header ? 8 : 4;
  for (std::size_t done = 0, got = 0; done < size; done += got) {
    got = bytes_.read(bytes + done, size - done);
    if (got == 0) fail("the file ends in the header of an array");
  }
  return place_.wide_header ? load_scalar<std::uint64_t>(bytes, place_.big_endian)
                            : load_scalar<std::uint32_t>(bytes, place_.big_endian);
}

// Nothing is reserved on the word of the header: a size takes room only after it was read.
void ArrayBytes::read_block_sizes() {
  const std::uint64_t count = header_number();
  if (count == 0) {
    size_ = 0;
    return;
  }
  block_bytes_ = header_number();
  last_block_bytes_ = header_number();
  if (last_block_bytes_ == 0) last_block_bytes_ = block_bytes_;
  if (block_bytes_ > kMostBlockBytes || last_block_bytes_ > block_bytes_ || block_bytes_ == 0 ||
      count > std::numeric_limits<std::uint64_t>::max() / block_bytes_)
    fail("the header of an array announces blocks of an impossible size");
  const std::uint64_t most = bytes_.source().size().value_or(std::numeric_limits<std::uint64_t>::max());
  if (count > most / 4) fail("the header of an array announces more blocks than the file has room for");
  for (std::uint64_t i = 0; i < count; ++i) {
    packed_sizes_.push_back(header_number());
    if (packed_sizes_.back() > std::min(most, kMostBlockBytes))
      fail("the header of an array announces a block that is larger than the file");
  }
  size_ = (count - 1) * block_bytes_ + last_block_bytes_;
}

std::size_t ArrayBytes::read(char* out, std::size_t limit) {
  if (place_.packing == BlockPacking::kNone) {
    const std::size_t got = bytes_.read(out, static_cast<std::size_t>(std::min<std::uint64_t>(limit, left_)));
    left_ -= got;
    return got;
  }
  if (taken_ == block_.size()) {
    if (next_block_ == packed_sizes_.size()) return 0;
    unpack_block();
  }
  const std::size_t count = std::min(limit, block_.size() - taken_);
  std::memcpy(out, block_.data() + taken_, count);
  taken_ += count;
  return count;
}

void ArrayBytes::read_packed(std::uint64_t size) {
  constexpr std::size_t kStep = std::size_t{1} << 20;
  packed_.clear();
  while (packed_.size() < size) {
    const std::size_t before = packed_.size();
    packed_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(size, before + kStep)));
    for (std::size_t done = before, got = 0; done < packed_.size(); done += got) {
      got = bytes_.read(packed_.data() + done, packed_.size() - done);
      if (got == 0) fail("the file ends in a packed array");
    }
  }
}

void ArrayBytes::unpack_block() {
  const std::uint64_t size = packed_sizes_[next_block_++];
  const std::uint64_t unpacked = next_block_ == packed_sizes_.size() ? last_block_bytes_ : block_bytes_;
  read_packed(size);
  if (unpacked > size * kMostUnpacked + kLeastUnpacked) fail("a packed block of an array is too short for its content");
  block_.resize(static_cast<std::size_t>(unpacked));
  taken_ = 0;
  bool whole = false;
  if (place_.packing == BlockPacking::kLz4) {
    whole = LZ4_decompress_safe(packed_.data(), block_.data(), static_cast<int>(size), static_cast<int>(unpacked)) ==
            static_cast<int>(unpacked);
  } else {
    auto got = static_cast<uLongf>(unpacked);
    whole = ::uncompress(reinterpret_cast<Bytef*>(block_.data()), &got, reinterpret_cast<const Bytef*>(packed_.data()),
                         static_cast<uLong>(size)) == Z_OK &&
            got == unpacked;
  }
  if (!whole) fail("a packed block of an array is damaged");
}

void ArrayBytes::fail(const std::string& what) const {
  throw Error(ErrorKind::kBadInput, what, "the file is cut or damaged; get a whole copy")
      .at(bytes_.source().name(), std::to_string(bytes_.offset()));
}

}  // namespace reeb::io
