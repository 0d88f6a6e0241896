#include "ooc/stored_graph/arc_payload.h"

#include "libreeb/base/byte_coding.h"
#include "libreeb/graph/packed_buckets.h"

namespace reeb::ooc {

void encode_list(std::span<const std::byte> packed, int exponent, std::vector<std::byte>& payload) {
  if (packed.empty()) return;
  ByteWriter(payload).varint(zigzag(static_cast<std::uint64_t>(exponent)));
  payload.insert(payload.end(), packed.begin(), packed.end());
}

std::uint64_t bucket_count(std::span<const std::byte> payload) {
  if (payload.empty()) return 0;
  ByteReader in(payload);
  in.delta(0);
  return in.varint();
}

bool decode_buckets(std::span<const std::byte> payload, int exponent, std::vector<Bucket>& buckets) {
  if (payload.empty()) return true;
  ByteReader in(payload);
  const auto own = static_cast<std::int64_t>(in.delta(0));
  const std::size_t first = buckets.size();
  if (!in.ok() || own > exponent || !unpack_buckets(in.bytes(in.remaining()), buckets)) return false;
  coarsen(buckets, first, static_cast<unsigned>(exponent - own));
  return true;
}

std::optional<std::span<const std::byte>> packed_list(std::span<const std::byte> payload, int exponent,
                                                      CoarsenedList& coarsened) {
  if (payload.empty()) return payload;
  ByteReader in(payload);
  const auto own = static_cast<std::int64_t>(in.delta(0));
  if (in.ok() && own == exponent) return in.bytes(in.remaining());
  coarsened.buckets.clear();
  if (!decode_buckets(payload, exponent, coarsened.buckets)) return std::nullopt;
  coarsened.packed.clear();
  pack_buckets(coarsened.buckets, coarsened.packed);
  return coarsened.packed;
}

}  // namespace reeb::ooc
