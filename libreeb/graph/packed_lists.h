// A packed list of buckets for each of many arcs (libreeb/graph/packed_buckets.h). Memory is reused when lists are
// replaced.
#pragma once

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
    const Place place = places_[arc];
    if (place.lines == 0) return;
    const std::byte* const first = chunks_[place.chunk].bytes.get() + place.offset;
    for (std::size_t line = 0; line < place.lines; ++line) reeb::prefetch(first + line * kLineBytes);
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
  static constexpr std::uint32_t kNoChunk = ~std::uint32_t{0};
  static constexpr std::size_t kLineBytes = 64, kMostLines = 4;
  // Where a list is, and the number of lines of the cache that prefetch() fetches of it: 0 if there is no list.
  struct Place {
    std::uint32_t chunk = 0;
    std::uint16_t offset = 0, lines = 0;
  };
  static_assert(sizeof(Place) == 8 && kChunkBytes <= 1u << 16);  // in a larger chunk, a list has the offset 0
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

  static Block block_at(const Chunk& chunk, std::uint32_t offset);
  // `open` is the chunk that such lists fill.
  Place store(std::uint32_t arc, std::span<const std::byte> list, std::uint32_t& open);
  std::uint32_t chunk_with_room(std::size_t bytes, std::uint32_t& open);
  std::uint32_t new_chunk(std::size_t room);
  bool is_open(std::uint32_t chunk) const { return chunk == open_ || chunk == open_for_moved_; }
  void forget(const Place& place);
  void note_if_empty(std::uint32_t chunk);
  void move_lists(std::uint32_t chunk);
  static void prefetch_bytes(const Chunk& chunk);
  void free(std::uint32_t chunk);
  void compact();
  std::uint64_t holes() const { return used_bytes_ - live_bytes_; }
  // Before and after compact(). Those of the open chunks stay.
  std::uint64_t most_holes() const { return 3 * live_bytes_ / 8 + 2 * kChunkBytes; }
  std::uint64_t fewest_holes() const { return most_holes() - live_bytes_ / 16; }

  std::vector<Place> places_;  // by arc
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
