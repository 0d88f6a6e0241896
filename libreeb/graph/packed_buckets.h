// Lists of buckets as bytes, for places that hold many of them.
//
// A list is its length, then for each bucket: the difference between its index and the index before (0 at first), its
// count with a mark, its mean, and, of several vertices, its spread and rim. The mark says whether the mean is in
// single precision. It is if that loses nothing, as for single vertices of most meshes. Most buckets take 14 bytes (one
// vertex) or 42, and at most kPackedBucketBytes unless the count is beyond 2^13. A list without buckets has no bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/byte_coding.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/graph/direction.h"

namespace reeb {

inline constexpr std::uint64_t kPackedBucketBytes = 44;
inline constexpr std::uint64_t kLeastPackedBucketBytes = 14;

// The most bytes of a bucket, and of a list of this length.
inline constexpr std::size_t kMostBucketBytes = 2 * kMaxVarintBytes + 24 + 16;
constexpr std::size_t most_packed_bytes(std::size_t count) { return kMaxVarintBytes + kMostBucketBytes * count; }

// Writes a list, without loss: unpack_buckets() yields equal buckets.
class BucketPacker {
 public:
  // For a list of this length. REQUIRES: from `to` on, there is room for most_packed_bytes().
  BucketPacker(std::uint64_t count, std::byte* to) : end_(count == 0 ? to : put_varint(to, count)) {}
  // The next bucket.
  void add(const Bucket& bucket);
  // The end of what was written.
  std::byte* end() const { return end_; }

 private:
  std::byte* end_;
  std::int64_t last_ = 0;  // index
};
// Appends a list.
void pack_buckets(std::span<const Bucket> buckets, std::vector<std::byte>& packed);

// Appends the buckets of a list. False if the bytes are not a list; a length that they cannot hold allocates nothing.
bool unpack_buckets(std::span<const std::byte> packed, std::vector<Bucket>& buckets);

// For a list that BucketPacker wrote: its length, O(1); and, if it is not empty, its last bucket in direction d, O(1)
// for kDown.
std::uint64_t packed_count(std::span<const std::byte> packed);
Bucket packed_end(std::span<const std::byte> packed, Direction d);

// The packed lists of an array of arcs.
class ArcLists {
 public:
  ArcListsView view() const { return {ends_, std::span(bytes_).first(size())}; }
  std::size_t memory_bytes() const { return ends_.capacity() * sizeof(std::uint64_t) + bytes_.capacity(); }
  // Keeps the memory.
  void clear() { ends_.clear(); }

  // The list of the next arc. list_buckets(add) calls add(bucket) for each of its `count` buckets, ascending.
  template <class ListBuckets>
  void add(std::size_t count, const ListBuckets& list_buckets) {
    BucketPacker packer(count, room_for(most_packed_bytes(count)));
    list_buckets([&packer](const Bucket& bucket) { packer.add(bucket); });
    ends_.push_back(static_cast<std::uint64_t>(packer.end() - bytes_.data()));
  }
  void add(std::span<const Bucket> buckets) {
    add(buckets.size(), [&](const auto& add_bucket) { std::ranges::for_each(buckets, add_bucket); });
  }
  void add_packed(std::span<const std::byte> list) {
    std::ranges::copy(list, room_for(list.size()));
    ends_.push_back(size() + list.size());
  }

 private:
  std::size_t size() const { return ends_.empty() ? 0 : ends_.back(); }
  // The end of the lists, with room for this many bytes more.
  std::byte* room_for(std::size_t more) {
    if (bytes_.size() - size() < more) bytes_.resize(std::max(size() + more, 2 * bytes_.size()));
    return bytes_.data() + size();
  }

  std::vector<std::uint64_t> ends_;
  std::vector<std::byte> bytes_;  // more than are in use, since to enlarge it for each list would cost more
};

}  // namespace reeb
