#include "io/decoding/vtk_data.h"

#include <lz4.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "io/decoding/inflate_input.h"
#include "io/mesh/scalar_bytes.h"
#include "io/text/hints.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::uint64_t kMostBlocks = std::uint64_t{1} << 24;
constexpr std::uint64_t kMostBlockBytes = std::uint64_t{1} << 26;
constexpr std::uint64_t kMostFromLz4 = 255;

class HeadedData : public VtkData {
 public:
  HeadedData(std::unique_ptr<ByteInput> stored, const VtkDataKind& kind) : VtkData(std::move(stored)), kind_(kind) {}

 protected:
  // Reads until there are `size` bytes.
  void take(char* out, std::size_t size) {
    while (size != 0) {
      const std::size_t got = input().read(out, size);
      if (got == 0) fail("the data of the array end too early");
      out += got;
      size -= got;
    }
  }

  std::uint64_t head_word() {
    char bytes[8];
    take(bytes, kind_.wide_head ? 8 : 4);
    return kind_.wide_head ? load_scalar<std::uint64_t>(bytes, kind_.big_endian)
                           : load_scalar<std::uint32_t>(bytes, kind_.big_endian);
  }

  void check_size(std::uint64_t bytes) const {
    if (kind_.bytes && bytes != *kind_.bytes)
      fail("the array has " + count_of(bytes, "byte") + ", but " + with_commas(*kind_.bytes) + " are needed");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::kBadInput, what, kCutOrDamagedHint).at(name(), std::to_string(offset()));
  }

  VtkDataKind kind_;
};

class PlainData final : public HeadedData {
 public:
  // The size is cut off in a head that is too narrow for it.
  PlainData(std::unique_ptr<ByteInput> stored, const VtkDataKind& kind) : HeadedData(std::move(stored), kind) {
    size_ = head_word();
    if (!kind.wide_head && kind.bytes && size_ == (*kind.bytes & 0xFFFF'FFFFu)) size_ = *kind.bytes;
    check_size(size_);
    left_ = size_;
  }
  std::uint64_t size() const override { return size_; }

  std::size_t read(char* out, std::size_t limit) override {
    if (left_ == 0) return 0;
    const std::size_t got = input().read(out, static_cast<std::size_t>(std::min<std::uint64_t>(limit, left_)));
    left_ -= got;
    return got;
  }

 private:
  std::uint64_t size_, left_;
};

class PackedData final : public HeadedData {
 public:
  PackedData(std::unique_ptr<ByteInput> stored, const VtkDataKind& kind) : HeadedData(std::move(stored), kind) {
    read_head();
  }
  std::uint64_t size() const override { return size_; }

  std::uint64_t memory_bytes() const override {
    return HeadedData::memory_bytes() + packed_sizes_.capacity() * sizeof(std::uint32_t) + packed_.capacity() +
           block_.capacity();
  }

  std::size_t read(char* out, std::size_t limit) override {
    while (next_ == block_.size()) {
      if (block_number_ == packed_sizes_.size()) return 0;
      unpack_block();
    }
    const std::size_t size = std::min(limit, block_.size() - next_);
    std::memcpy(out, block_.data() + next_, size);
    next_ += size;
    return size;
  }

 private:
  void read_head() {
    const std::uint64_t blocks = head_word();
    block_bytes_ = head_word();
    const std::uint64_t last_bytes = head_word();
    if (blocks > kMostBlocks || block_bytes_ > kMostBlockBytes || last_bytes > block_bytes_)
      fail("the array has " + count_of(blocks, "block") + " of " + count_of(block_bytes_, "byte") +
           ", which is not a valid header");
    last_bytes_ = last_bytes == 0 ? block_bytes_ : last_bytes;
    size_ = blocks == 0 ? 0 : (blocks - 1) * block_bytes_ + last_bytes_;
    check_size(size_);
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const std::uint64_t size = head_word();
      if (size > 2 * kMostBlockBytes) fail("a packed block has " + count_of(size, "byte"));
      packed_sizes_.push_back(static_cast<std::uint32_t>(size));
    }
  }

  void unpack_block() {
    const std::size_t packed_bytes = packed_sizes_[block_number_++];
    const bool is_last = block_number_ == packed_sizes_.size();
    const std::uint64_t bytes = is_last ? last_bytes_ : block_bytes_;
    take_packed(packed_bytes);
    const bool zlib = kind_.packing == BlockPacking::kZlib;
    // What cannot be in these packed bytes is not made room for.
    if (bytes > (packed_bytes + 1) * (zlib ? kMostInflated : kMostFromLz4)) fail_block();
    block_.resize(static_cast<std::size_t>(bytes));
    next_ = 0;
    if (zlib) {
      uLongf size = bytes;
      const int state = uncompress(reinterpret_cast<Bytef*>(block_.data()), &size,
                                   reinterpret_cast<const Bytef*>(packed_.data()), packed_bytes);
      if (state != Z_OK || size != bytes) fail_block();
    } else if (LZ4_decompress_safe(packed_.data(), block_.data(), static_cast<int>(packed_bytes),
                                   static_cast<int>(bytes)) != static_cast<int>(bytes)) {
      fail_block();
    }
  }

  // Room is made as the bytes arrive.
  void take_packed(std::size_t bytes) {
    constexpr std::size_t kStep = 65536;
    packed_.clear();
    while (packed_.size() < bytes) {
      const std::size_t old = packed_.size(), step = std::min(kStep, bytes - old);
      packed_.resize(old + step);
      take(packed_.data() + old, step);
    }
  }

  [[noreturn]] void fail_block() const { fail("block " + with_commas(block_number_) + " of the array is damaged"); }

  std::uint64_t size_ = 0, block_bytes_ = 0, last_bytes_ = 0;
  std::vector<std::uint32_t> packed_sizes_;
  std::size_t block_number_ = 0;  // of the next block
  std::vector<char> packed_, block_;
  std::size_t next_ = 0;  // in block_
};

}  // namespace

std::uint64_t least_stored_bytes(const VtkDataKind& kind) {
  const std::uint64_t head = kind.wide_head ? 8 : 4;
  switch (kind.packing) {
    case BlockPacking::kNone:
      return head + *kind.bytes;
    case BlockPacking::kZlib:
      return *kind.bytes / kMostInflated;
    case BlockPacking::kLz4:
      break;
  }
  return *kind.bytes / kMostFromLz4;
}

std::unique_ptr<VtkData> vtk_data(std::unique_ptr<ByteInput> stored, const VtkDataKind& kind) {
  if (kind.packing == BlockPacking::kNone) return std::make_unique<PlainData>(std::move(stored), kind);
  return std::make_unique<PackedData>(std::move(stored), kind);
}

}  // namespace reeb::io
