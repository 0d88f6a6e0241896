#include "libreeb/graph/packed_lists.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <utility>

#include "libreeb/base/byte_coding.h"
#include "libreeb/graph/packed_buckets.h"

namespace reeb {
namespace {

// A list comes after its arc, in four bytes, and the varint of its size.
constexpr std::size_t kArcBytes = 4, kMaxSizeBytes = 5;

}  // namespace

void PackedLists::add(std::span<const Bucket> buckets) {
  packed_.clear();
  pack_buckets(buckets, packed_);
  add_packed(packed_);
}

void PackedLists::add_packed(std::span<const std::byte> packed) {
  places_.emplace_back();
  replace(places_.size() - 1, packed);
}

std::uint64_t PackedLists::memory_bytes() const {
  return places_.capacity() * sizeof(Place) + chunks_.capacity() * sizeof(Chunk) + chunk_bytes_ +
         (spare_ != nullptr ? kChunkBytes : 0);
}

std::uint64_t PackedLists::most_bytes(std::uint64_t arcs, std::uint64_t buckets) {
  constexpr std::uint64_t kListBytes = kArcBytes + 2 + 3;  // arc, size in bytes, length
  const std::uint64_t bytes = kPackedBucketBytes * buckets + kListBytes * std::min(arcs, buckets);
  return sizeof(Place) * arcs + bytes + bytes / (kListsPerChunk - 1) + 2 * kChunkBytes;
}

std::span<const std::byte> PackedLists::of(std::size_t arc) const {
  const Place place = places_[arc];
  if (place.lines == 0) return {};
  return block_at(chunks_[place.chunk], place.offset).list;
}

void PackedLists::replace(std::size_t arc, std::span<const std::byte> packed) {
  if (places_[arc].lines != 0) forget(places_[arc]);
  places_[arc] = packed.empty() ? Place{} : store(static_cast<std::uint32_t>(arc), packed, open_);
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

PackedLists::Place PackedLists::store(std::uint32_t arc, std::span<const std::byte> list, std::uint32_t& open) {
  const std::size_t most = kArcBytes + kMaxSizeBytes + list.size();
  if (most > ~std::uint32_t{0}) throw std::length_error("PackedLists: a list of 4 GiB");
  const std::uint32_t index = chunk_with_room(most, open);
  Chunk& chunk = chunks_[index];
  const std::uint32_t offset = chunk.used;
  std::byte* to = chunk.bytes.get() + offset;
  std::memcpy(to, &arc, kArcBytes);
  to = put_varint(to + kArcBytes, list.size());
  std::memcpy(to, list.data(), list.size());
  chunk.used = static_cast<std::uint32_t>(to + list.size() - chunk.bytes.get());
  const std::uint32_t stored = chunk.used - offset;
  chunk.live += stored;
  used_bytes_ += stored;
  live_bytes_ += stored;
  const std::size_t before = reinterpret_cast<std::uintptr_t>(chunk.bytes.get() + offset) % kLineBytes;  // in a line
  const std::size_t lines = std::min((before + stored + kLineBytes - 1) / kLineBytes, kMostLines);
  return {index, static_cast<std::uint16_t>(offset), static_cast<std::uint16_t>(lines)};
}

// A large list has a chunk of its own, so that little room is lost at the ends of chunks.
std::uint32_t PackedLists::chunk_with_room(std::size_t bytes, std::uint32_t& open) {
  if (bytes > kChunkBytes / kListsPerChunk) return new_chunk(bytes);
  if (open != kNoChunk && chunks_[open].room - chunks_[open].used >= bytes) return open;
  const std::uint32_t full = std::exchange(open, new_chunk(kChunkBytes));
  if (full != kNoChunk) note_if_empty(full);
  return open;
}

std::uint32_t PackedLists::new_chunk(std::size_t room) {
  if (free_.empty()) {
    free_.push_back(static_cast<std::uint32_t>(chunks_.size()));
    chunks_.emplace_back();
  }
  const std::uint32_t index = free_.back();
  free_.pop_back();
  const bool has_spare = spare_ != nullptr && room == kChunkBytes;
  chunks_[index] = {has_spare ? std::move(spare_) : std::make_unique_for_overwrite<std::byte[]>(room),
                    static_cast<std::uint32_t>(room)};
  chunk_bytes_ += room;
  return index;
}

void PackedLists::forget(const Place& place) {
  const std::uint32_t size = block_at(chunks_[place.chunk], place.offset).end - place.offset;
  chunks_[place.chunk].live -= size;
  live_bytes_ -= size;
  held_bytes_ += size;
  note_if_empty(place.chunk);
}

void PackedLists::note_if_empty(std::uint32_t index) {
  if (chunks_[index].live == 0 && !is_open(index)) empty_.push_back(index);
}

// A list takes one new chunk at most, so chunks_ is not resized in the meantime.
void PackedLists::hold(std::size_t replaced) {
  while (free_.size() < replaced) {
    free_.push_back(static_cast<std::uint32_t>(chunks_.size()));
    chunks_.emplace_back();
  }
  held_bytes_ = 0;
  is_held_ = true;
}

void PackedLists::release() {
  is_held_ = false;
  collect();
}

void PackedLists::collect() {
  if (is_held_) return;
  for (const std::uint32_t chunk : empty_) free(chunk);
  empty_.clear();
  if (holes() > most_holes()) compact();
}

// Moves the lists of the emptiest chunks, until there are few enough holes.
void PackedLists::compact() {
  std::vector<std::uint32_t> chunks;
  for (std::uint32_t i = 0; i < chunks_.size(); ++i)
    if (!is_open(i) && chunks_[i].live < chunks_[i].used) chunks.push_back(i);
  const auto share = [this](std::uint32_t i) { return (std::uint64_t{chunks_[i].live} << 32) / chunks_[i].used; };
  std::ranges::sort(chunks, std::less<>(), share);
  for (const std::uint32_t chunk : chunks) {
    if (holes() <= fewest_holes()) break;
    move_lists(chunk);
    free(chunk);
  }
}

void PackedLists::move_lists(std::uint32_t index) {
  prefetch_bytes(chunks_[index]);
  // Their arcs can be anywhere in places_.
  for (std::uint32_t offset = 0; offset < chunks_[index].used;) {
    const Block block = block_at(chunks_[index], offset);
    prefetch_place(block.arc);
    offset = block.end;
  }
  for (std::uint32_t offset = 0; chunks_[index].live != 0 && offset < chunks_[index].used;) {
    const Block block = block_at(chunks_[index], offset);
    const std::uint32_t size = block.end - offset;
    const Place& place = places_[block.arc];
    if (place.lines != 0 && place.chunk == index && place.offset == offset) {
      chunks_[index].live -= size;
      live_bytes_ -= size;
      places_[block.arc] = store(block.arc, block.list, open_for_moved_);
    }
    offset = block.end;
  }
}

// Each list says where the next one begins, so without this every step would wait for memory.
void PackedLists::prefetch_bytes(const Chunk& chunk) {
  const std::size_t end = std::min<std::size_t>(chunk.used, kChunkBytes);
  for (std::size_t at = 0; at < end; at += kLineBytes) reeb::prefetch(chunk.bytes.get() + at);
}

void PackedLists::free(std::uint32_t index) {
  Chunk& chunk = chunks_[index];
  chunk_bytes_ -= chunk.room;
  used_bytes_ -= chunk.used;
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
