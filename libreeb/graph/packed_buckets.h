// Lists of buckets as bytes: the form in which they are kept where there are many.
//
// A list is its length, then for each bucket the difference of its index to that of the one before (0
// at first), its count with a mark, and its mean: in single precision where that loses nothing, as for
// single vertices of most meshes, else in double. Most buckets take 14 or 26 bytes, and 28 at most but
// for counts beyond 2^13. A list without buckets has no bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/bucket.h"

namespace reeb {

// Appends the list. Nothing is lost: unpack_buckets() gives equal buckets.
void pack_buckets(std::span<const Bucket> buckets, std::vector<std::byte>& packed);

// Appends the buckets of a list. False if the bytes are no list; nothing is sized by a length that they
// cannot hold.
bool unpack_buckets(std::span<const std::byte> packed, std::vector<Bucket>& buckets);

// The length of a list. REQUIRES: pack_buckets() wrote it. O(1).
std::uint64_t packed_count(std::span<const std::byte> packed);

}  // namespace reeb
