// A packed list of buckets for each of many arcs (libreeb/graph/packed_buckets.h). Memory is reused when lists are
// replaced.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "libreeb/base/prefetch.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/bucket.h"

namespace reeb {

// Lists are stored in memory chunks, each list after the number of its arc. A list that was replaced stays readable
// until collect(). That frees chunks without a list in use. When there are too many holes, it moves the lists of the
// emptiest chunks to another one. It pays to wait: lists that change often are stored together, so few of them are left
// in their chunks by then. Lists that were moved change less often, so they have chunks of their own.
//
// THREADS: between hold() and release(), one thread may replace lists while another one reads lists that are not
// replaced in this time, with of().
//
// MEMORY: 8 bytes per arc; for each list its bytes and 6 more, and up to 3/8 as much again for holes; five chunks.
class PackedLists {
 public:
  void reserve(std::size_t arcs) { places_.reserve(arcs); }
  // Appends an arc with its buckets.
  void add(std::span<const Bucket> buckets);
  void add_packed(std::span<const std::byte> packed);

  std::size_t size() const { return places_.size(); }
  // The memory that it holds at present.
  std::uint64_t memory_bytes() const;
  // The most memory that it holds after adding these numbers of arcs and buckets, whose counts are up to 2^13.
  static std::uint64_t most_bytes(std::uint64_t arcs, std::uint64_t buckets);
  // Empty for an arc without buckets. Valid until the next collect().
  std::span<const std::byte> of(std::size_t arc) const;

  // Prefetches where the list is stored; when that has arrived, prefetch() fetches the list.
  void prefetch_place(std::size_t arc) const { reeb::prefetch(&places_[arc]); }
  void prefetch(std::size_t arc) const {
    constexpr std::uint32_t kLineBytes = 64, kBytes = 128;  // most lists are no longer
    const std::uint64_t place = places_[arc];
    if (place == kNowhere) return;
    const Chunk& chunk = chunks_[place >> 32];
    const auto first = static_cast<std::uint32_t>(place), end = std::min(chunk.used, first + kBytes);
    for (std::uint32_t at = first; at < end; at += kLineBytes) reeb::prefetch(chunk.bytes.get() + at);
  }

  void replace(std::size_t arc, std::span<const std::byte> packed);
  void collect();

  // From now on collect() does nothing. REQUIRES: at most this many lists are replaced before release(), which
  // collects. MEMORY: kHeldBytes for each, about. This memory is kept for the next hold().
  static constexpr std::size_t kHeldBytes = 28;
  void hold(std::size_t replaced);
  void release();
  // Whether replaced lists take so much memory, 64 KiB and a 32nd of all, that it is time for release().
  bool holds_much() const { return is_held_ && held_bytes_ > kChunkBytes + chunk_bytes_ / 32; }

 private:
  static constexpr std::size_t kChunkBytes = 64 << 10;
  static constexpr std::size_t kListsPerChunk = 8;  // at least
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};
  static constexpr std::uint32_t kNoChunk = ~std::uint32_t{0};
  struct Chunk {
    std::unique_ptr<std::byte[]> bytes;
    std::uint32_t room = 0, used = 0, live = 0;
  };
  static_assert(kHeldBytes == sizeof(Chunk) + sizeof(std::uint32_t));  // an entry of chunks_ and of free_
  // A list and the number of its arc, as stored in a chunk.
  struct Block {
    std::uint32_t arc;
    std::span<const std::byte> list;
    std::uint32_t end;  // offset of the end in the chunk
  };

  static std::uint64_t place(std::uint32_t chunk, std::uint32_t offset) { return std::uint64_t{chunk} << 32 | offset; }
  static Block block_at(const Chunk& chunk, std::uint32_t offset);
  // `open` is the chunk that such lists fill.
  std::uint64_t store(std::uint32_t arc, std::span<const std::byte> list, std::uint32_t& open);
  std::uint32_t chunk_with_room(std::size_t bytes, std::uint32_t& open);
  std::uint32_t new_chunk(std::size_t room);
  bool is_open(std::uint32_t chunk) const { return chunk == open_ || chunk == open_for_moved_; }
  void forget(std::uint64_t place);
  void note_if_empty(std::uint32_t chunk);
  void move_lists(std::uint32_t chunk);
  static void prefetch_bytes(const Chunk& chunk);
  void free(std::uint32_t chunk);
  void compact();
  std::uint64_t holes() const { return used_bytes_ - live_bytes_; }
  // Before and after compact(). Those of the open chunks stay.
  std::uint64_t most_holes() const { return 3 * live_bytes_ / 8 + 2 * kChunkBytes; }
  std::uint64_t fewest_holes() const { return most_holes() - live_bytes_ / 16; }

  std::vector<std::uint64_t> places_;  // by arc: chunk and offset
  std::vector<Chunk> chunks_;
  std::vector<std::uint32_t> free_;                            // chunks without memory
  std::vector<std::uint32_t> empty_;                           // chunks without a list in use, to be freed
  std::unique_ptr<std::byte[]> spare_;                         // memory of a freed chunk
  std::uint32_t open_ = kNoChunk, open_for_moved_ = kNoChunk;  // the chunks that are being filled
  std::uint64_t chunk_bytes_ = 0;                              // of all chunks
  std::uint64_t used_bytes_ = 0, live_bytes_ = 0;              // of all lists in them, and of those in use
  std::uint64_t held_bytes_ = 0;                               // of the lists that were replaced since hold()
  bool is_held_ = false;
  std::vector<std::byte> packed_;  // of add()
};

// The lists of all arcs; without an embedding, no lists.
PackedLists pack_lists(const ArcBucketsView& buckets);

}  // namespace reeb
