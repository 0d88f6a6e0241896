#include "ooc/tables/triangle_log.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "libreeb/base/byte_coding.h"

namespace reeb::ooc {

namespace {

static_assert(std::endian::native == std::endian::little, "low bytes are copied first");

// Block: a 4-byte count of the bytes used, then triangles. The decoder loads 8 bytes at a time, so a block ends with
// room for one load.
constexpr std::size_t kCountBytes = 4;
constexpr std::size_t kTriangleBytesLimit = 1 + 3 * 8;
constexpr std::size_t kSlackBytes = 8;

constexpr std::array<std::size_t, 4> kLength = {1, 2, 4, 8};
constexpr std::array<std::uint64_t, 4> kMask = {0xff, 0xffff, 0xffff'ffff, ~std::uint64_t{0}};

unsigned length_code(std::uint64_t value) {
  return value <= kMask[0] ? 0u : value <= kMask[1] ? 1u : value <= kMask[2] ? 2u : 3u;
}

}  // namespace

TriangleLog::TriangleLog(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes)
    : temp_(&temp),
      allowance_(allowance_bytes),
      charge_(budget.reserve("triangles", 2 * kBlockBytes)),
      open_(std::make_unique<std::byte[]>(kBlockBytes)),
      write_at_(kCountBytes) {}

void TriangleLog::append(std::span<const VertexId> corners) {
  for (std::size_t t = 0; t + 3 <= corners.size(); t += 3) {
    if (write_at_ + kTriangleBytesLimit + kSlackBytes > kBlockBytes) seal_block();
    const std::uint64_t first = corners[t].value();
    const std::array<std::uint64_t, 3> codes = {zigzag(first - write_before_), zigzag(corners[t + 1].value() - first),
                                                zigzag(corners[t + 2].value() - first)};
    std::byte* out = open_.get() + write_at_;
    unsigned lengths = 0;
    std::size_t size = 1;
    for (unsigned c = 0; c < 3; ++c) {
      const unsigned length = length_code(codes[c]);
      lengths |= length << (2 * c);
      std::memcpy(out + size, &codes[c], kLength[length]);
      size += kLength[length];
    }
    out[0] = static_cast<std::byte>(lengths);
    write_at_ += size;
    write_before_ = first;
  }
  triangle_count_ += corners.size() / 3;
}

void TriangleLog::seal_block() {
  const auto used = static_cast<std::uint32_t>(write_at_);
  std::memcpy(open_.get(), &used, kCountBytes);
  const std::uint64_t kept_bytes = (in_memory_.size() + 1) * kBlockBytes;
  if (block_count_ == in_memory_.size() && kept_bytes <= allowance_ &&
      charge_.try_resize(2 * kBlockBytes + kept_bytes)) {
    in_memory_.push_back(std::exchange(open_, std::make_unique<std::byte[]>(kBlockBytes)));
  } else {
    if (!file_.is_open()) file_ = temp_->create_unnamed("triangles");
    file_.write_at((block_count_ - in_memory_.size()) * kBlockBytes, {open_.get(), kBlockBytes});
  }
  ++block_count_;
  write_at_ = kCountBytes;
  write_before_ = 0;
}

const std::byte* TriangleLog::block(std::uint64_t index) {
  if (index < in_memory_.size()) return in_memory_[static_cast<std::size_t>(index)].get();
  if (index == block_count_) {
    const auto used = static_cast<std::uint32_t>(write_at_);
    std::memcpy(open_.get(), &used, kCountBytes);
    return open_.get();
  }
  if (fetched_index_ != index) {
    if (fetched_ == nullptr) fetched_ = std::make_unique<std::byte[]>(kBlockBytes);
    file_.read_at((index - in_memory_.size()) * kBlockBytes, {fetched_.get(), kBlockBytes});
    fetched_index_ = index;
  }
  return fetched_.get();
}

void TriangleLog::rewind() {
  read_block_ = 0;
  read_at_ = 0;
  read_before_ = 0;
}

void TriangleLog::seek(const MeshPlace& place) {
  read_block_ = place.first / kBlockBytes;
  read_at_ = static_cast<std::size_t>(place.first % kBlockBytes);
  read_before_ = place.second;
}

bool TriangleLog::read(std::vector<VertexId>& corners, std::size_t limit) {
  corners.clear();
  while (corners.size() < 3 * limit && read_block_ <= block_count_) {
    const std::byte* bytes = block(read_block_);
    std::uint32_t used = 0;
    std::memcpy(&used, bytes, kCountBytes);
    read_at_ = std::max(read_at_, kCountBytes);
    while (read_at_ < used && corners.size() < 3 * limit) {
      const auto lengths = std::to_integer<unsigned>(bytes[read_at_++]);
      std::array<std::uint64_t, 3> differences;
      for (unsigned c = 0; c < 3; ++c) {
        const unsigned length = lengths >> (2 * c) & 3u;
        std::uint64_t code = 0;
        std::memcpy(&code, bytes + read_at_, sizeof(code));
        differences[c] = unzigzag(code & kMask[length]);
        read_at_ += kLength[length];
      }
      const std::uint64_t first = read_before_ + differences[0];
      corners.emplace_back(first);
      corners.emplace_back(first + differences[1]);
      corners.emplace_back(first + differences[2]);
      read_before_ = first;
    }
    if (read_at_ < used) break;
    if (read_block_ == block_count_) break;  // stays at the end
    ++read_block_;
    read_at_ = 0;
    read_before_ = 0;
  }
  return !corners.empty();
}

}  // namespace reeb::ooc
