#include "ooc/arc_payload.h"

#include "libreeb/format/byte_coding.h"

namespace reeb::ooc {

void encode_buckets(std::span<const Bucket> buckets, int exponent, std::vector<std::byte>& payload) {
  if (buckets.empty()) return;
  ByteWriter out(payload);
  out.delta(static_cast<std::uint64_t>(exponent), 0);
  out.varint(buckets.size());
  std::uint64_t before = 0;
  for (const Bucket& bucket : buckets) {
    const auto index = static_cast<std::uint64_t>(bucket.index);
    out.delta(index, before);
    before = index;
    out.varint(bucket.count);
    for (const double mean : bucket.mean) out.f64(mean);
  }
}

bool decode_buckets(std::span<const std::byte> payload, int exponent, std::vector<Bucket>& buckets) {
  if (payload.empty()) return true;
  ByteReader in(payload);
  const auto own = static_cast<std::int64_t>(in.delta(0));
  const std::uint64_t count = in.varint();
  if (own > exponent || !in.may_hold(count, 26)) return false;
  const std::size_t first = buckets.size();
  std::uint64_t index = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    Bucket bucket;
    index = in.delta(index);
    bucket.index = static_cast<std::int64_t>(index);
    bucket.count = in.varint();
    for (double& mean : bucket.mean) mean = in.f64();
    buckets.push_back(bucket);
  }
  coarsen(buckets, first, static_cast<unsigned>(exponent - own));
  return in.done();
}

}  // namespace reeb::ooc
