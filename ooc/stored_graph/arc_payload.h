// The buckets of an arc as the payload with which it is sorted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libreeb/graph/bucket.h"

namespace reeb::ooc {

// Appends the payload: the exponent as a varint, then the packed list (packed_buckets.h). An arc without
// buckets has none.
void encode_buckets(std::span<const Bucket> buckets, int exponent, std::vector<std::byte>& payload);
// The same for a list that is packed already.
void encode_packed_buckets(std::span<const std::byte> packed, int exponent, std::vector<std::byte>& payload);

// Appends the buckets of a payload, coarsened to `exponent`. False if the bytes are no payload, or
// are coarser.
bool decode_buckets(std::span<const std::byte> payload, int exponent, std::vector<Bucket>& buckets);

// The packed list of a payload, coarsened to `exponent`. Nothing if the bytes are no payload, or are coarser.
// A list that has this exponent already, as nearly all do, is not unpacked: it lies in the payload. Else it is in
// `coarsened`, until the next call.
struct CoarsenedList {
  std::vector<Bucket> buckets;
  std::vector<std::byte> packed;
};
std::optional<std::span<const std::byte>> packed_list(std::span<const std::byte> payload, int exponent,
                                                      CoarsenedList& coarsened);

// How many buckets a payload has, before any is coarsened.
std::uint64_t bucket_count(std::span<const std::byte> payload);

}  // namespace reeb::ooc
