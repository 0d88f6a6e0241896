#include "libreeb/hierarchy/packed_lists.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "libreeb/graph/packed_buckets.h"

namespace reeb {
namespace {

// Before a list: the arc in four bytes, then the size, seven bits a byte.
constexpr std::size_t kArcBytes = 4, kMostSizeBytes = 5;

}  // namespace

void PackedLists::add(std::span<const Bucket> buckets) {
  packed_.clear();
  pack_buckets(buckets, packed_);
  places_.push_back(kNowhere);
  replace(places_.size() - 1, packed_);
}

std::span<const std::byte> PackedLists::of(std::size_t arc) const {
  const std::uint64_t place = places_[arc];
  if (place == kNowhere) return {};
  return block_at(chunks_[place >> 32], static_cast<std::uint32_t>(place)).list;
}

void PackedLists::replace(std::size_t arc, std::span<const std::byte> packed) {
  if (places_[arc] != kNowhere) forget(places_[arc]);
  places_[arc] = packed.empty() ? kNowhere : store(static_cast<std::uint32_t>(arc), packed);
}

PackedLists::Block PackedLists::block_at(const Chunk& chunk, std::uint32_t offset) {
  const std::byte* at = chunk.bytes.get() + offset;
  std::uint32_t arc = 0, size = 0;
  std::memcpy(&arc, at, kArcBytes);
  at += kArcBytes;
  for (unsigned shift = 0;; shift += 7) {
    const auto byte = std::to_integer<std::uint32_t>(*at++);
    size |= (byte & 0x7f) << shift;
    if ((byte & 0x80) == 0) break;
  }
  return {arc, {at, size}, static_cast<std::uint32_t>(at - chunk.bytes.get()) + size};
}

std::uint64_t PackedLists::store(std::uint32_t arc, std::span<const std::byte> list) {
  const std::size_t most = kArcBytes + kMostSizeBytes + list.size();
  if (most > ~std::uint32_t{0}) throw std::length_error("PackedLists: a list of 4 GiB");
  if (open_ == kNoChunk || chunks_[open_].room - chunks_[open_].used < most) open_chunk(most);
  Chunk& chunk = chunks_[open_];
  const std::uint32_t offset = chunk.used;
  std::byte* to = chunk.bytes.get() + offset;
  std::memcpy(to, &arc, kArcBytes);
  to += kArcBytes;
  std::size_t size = list.size();
  for (; size >= 0x80; size >>= 7) *to++ = static_cast<std::byte>(size | 0x80);
  *to++ = static_cast<std::byte>(size);
  std::memcpy(to, list.data(), list.size());
  chunk.used = static_cast<std::uint32_t>(to + list.size() - chunk.bytes.get());
  chunk.live += chunk.used - offset;
  return place(open_, offset);
}

// A list that is larger than a chunk gets one of its own.
void PackedLists::open_chunk(std::size_t least) {
  const std::uint32_t before = open_;
  if (free_.empty()) {
    open_ = static_cast<std::uint32_t>(chunks_.size());
    chunks_.emplace_back();
  } else {
    open_ = free_.back();
    free_.pop_back();
  }
  Chunk& chunk = chunks_[open_];
  const std::size_t room = std::max(least, kChunkBytes);
  const bool has_spare = spare_ != nullptr && room == kChunkBytes;
  chunk = {has_spare ? std::move(spare_) : std::make_unique_for_overwrite<std::byte[]>(room),
           static_cast<std::uint32_t>(room)};
  // What was spared while it was being filled may be little now.
  if (before != kNoChunk && chunks_[before].live < kLeastLive * chunks_[before].used) {
    chunks_[before].is_due = true;
    due_.push_back(before);
  }
}

void PackedLists::forget(std::uint64_t place) {
  const auto index = static_cast<std::uint32_t>(place >> 32), offset = static_cast<std::uint32_t>(place);
  Chunk& chunk = chunks_[index];
  chunk.live -= block_at(chunk, offset).end - offset;
  if (index == open_ || chunk.is_due || chunk.live >= kLeastLive * chunk.used) return;
  chunk.is_due = true;
  due_.push_back(index);
}

void PackedLists::collect() {
  // What moves may fill the open chunk, which then may be due itself.
  while (!due_.empty()) {
    const std::uint32_t chunk = due_.back();
    due_.pop_back();
    give_up(chunk);
  }
}

void PackedLists::give_up(std::uint32_t index) {
  for (std::uint32_t offset = 0; chunks_[index].live != 0 && offset < chunks_[index].used;) {
    const Block block = block_at(chunks_[index], offset);
    if (places_[block.arc] == place(index, offset)) {
      chunks_[index].live -= block.end - offset;
      places_[block.arc] = store(block.arc, block.list);
    }
    offset = block.end;
  }
  Chunk& chunk = chunks_[index];
  if (chunk.room == kChunkBytes && spare_ == nullptr) spare_ = std::move(chunk.bytes);
  chunk = {};
  free_.push_back(index);
}

PackedLists pack_lists(const ArcBucketsView& buckets) {
  PackedLists lists;
  for (std::size_t arc = 0; arc + 1 < buckets.offsets.size(); ++arc) lists.add(buckets.of(arc));
  return lists;
}

}  // namespace reeb
