// Lists of buckets as bytes, for places that hold many of them.
//
// A list is its length, then for each bucket: the difference between its index and the index before (0 at first), its
// count with a mark, its mean, and, of several vertices, its spread and rim. The mark says whether the mean is in
// single precision. It is if that loses nothing, as for single vertices of most meshes. Most buckets take 14 bytes (one
// vertex) or 42, and at most kPackedBucketBytes unless the count is beyond 2^13. A list without buckets has no bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/bucket.h"

namespace reeb {

inline constexpr std::uint64_t kPackedBucketBytes = 44;
inline constexpr std::uint64_t kLeastPackedBucketBytes = 14;

// Appends the list, without loss: unpack_buckets() yields equal buckets.
void pack_buckets(std::span<const Bucket> buckets, std::vector<std::byte>& packed);

// Appends the buckets of a list. False if the bytes are not a list; a length that they cannot hold allocates nothing.
bool unpack_buckets(std::span<const std::byte> packed, std::vector<Bucket>& buckets);

// The length of a list. REQUIRES: pack_buckets() wrote it. O(1).
std::uint64_t packed_count(std::span<const std::byte> packed);

}  // namespace reeb
