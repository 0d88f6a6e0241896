// The buckets of an arc as the payload of its record in sorting.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libreeb/graph/bucket.h"

namespace reeb::ooc {

// Appends the payload of a packed list (packed_buckets.h): the exponent as a varint, then the list. The payload of an
// arc without buckets is empty.
void encode_list(std::span<const std::byte> packed, int exponent, std::vector<std::byte>& payload);

// Appends the buckets of a payload, coarsened to `exponent`. False if the bytes are not a payload, or are coarser than
// that.
bool decode_buckets(std::span<const std::byte> payload, int exponent, std::vector<Bucket>& buckets);

// Room for a list that packed_list() coarsens.
struct CoarsenedList {
  std::vector<Bucket> buckets;
  std::vector<std::byte> packed;
};
// The packed list of a payload, coarsened to `exponent`; empty without buckets, nothing if the bytes are not a payload,
// or are coarser than that. Nearly every list already has this exponent. It is not unpacked, and the result points into
// the payload. Else the result points into `coarsened` and is valid until the next call.
std::optional<std::span<const std::byte>> packed_list(std::span<const std::byte> payload, int exponent,
                                                      CoarsenedList& coarsened);

// The number of buckets of a payload, before coarsening.
std::uint64_t bucket_count(std::span<const std::byte> payload);

}  // namespace reeb::ooc
