#include "libreeb/graph/packed_buckets.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include "libreeb/base/byte_coding.h"

namespace reeb {
namespace {

using Single = std::array<float, 3>;
static_assert(kLeastPackedBucketBytes == 2 + sizeof(Single));
static_assert(kMostBucketBytes ==
              2 * kMaxVarintBytes + sizeof(Bucket::mean) + sizeof(Bucket::spread) + sizeof(Bucket::rim));

bool is_single(const std::array<double, 3>& mean) {
  return std::ranges::all_of(mean, [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
}

template <class T>
std::byte* put_raw(std::byte* to, const T& value) {
  std::memcpy(to, &value, sizeof(value));
  return to + sizeof(value);
}

// Leaves `value` as it is if there are too few bytes.
template <class T>
void get_raw(ByteReader& in, T& value) {
  if (const auto bytes = in.bytes(sizeof(T)); !bytes.empty()) std::memcpy(&value, bytes.data(), sizeof(T));
}

// The next bucket, which is new. `last` is the index of the one before, and its own is returned. Always inlined, since
// a call would keep the reader in memory and not in registers.
[[gnu::always_inline]] inline std::int64_t get_bucket(ByteReader& in, std::int64_t last, Bucket& bucket) {
  bucket.index = static_cast<std::int64_t>(in.delta(static_cast<std::uint64_t>(last)));
  const std::uint64_t count_and_form = in.varint();
  bucket.count = count_and_form >> 1;
  if ((count_and_form & 1) == 0) {
    get_raw(in, bucket.mean);
  } else {
    Single mean{};
    get_raw(in, mean);
    for (std::size_t k = 0; k < mean.size(); ++k) bucket.mean[k] = static_cast<double>(mean[k]);
  }
  if (bucket.count > 1) {
    get_raw(in, bucket.spread);
    get_raw(in, bucket.rim);
  }
  return bucket.index;
}

}  // namespace

void BucketPacker::add(const Bucket& bucket) {
  const bool single = is_single(bucket.mean);
  std::byte* to =
      put_varint(end_, delta_code(static_cast<std::uint64_t>(bucket.index), static_cast<std::uint64_t>(last_)));
  to = put_varint(to, bucket.count << 1 | (single ? 1 : 0));
  const auto& [x, y, z] = bucket.mean;
  to = single ? put_raw(to, Single{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)})
              : put_raw(to, bucket.mean);
  if (bucket.count > 1) to = put_raw(put_raw(to, bucket.spread), bucket.rim);
  end_ = to;
  last_ = bucket.index;
}

void pack_buckets(std::span<const Bucket> buckets, std::vector<std::byte>& packed) {
  const std::size_t before = packed.size();
  packed.resize(before + most_packed_bytes(buckets.size()));
  BucketPacker packer(buckets.size(), packed.data() + before);
  for (const Bucket& bucket : buckets) packer.add(bucket);
  packed.resize(static_cast<std::size_t>(packer.end() - packed.data()));
}

bool unpack_buckets(std::span<const std::byte> packed, std::vector<Bucket>& buckets) {
  if (packed.empty()) return true;
  ByteReader in(packed);
  const std::uint64_t count = in.varint();
  if (!in.may_hold(count, kLeastPackedBucketBytes)) return false;
  std::int64_t index = 0;
  // In place, since copying a bucket whose parts were just stored waits for these stores.
  for (std::uint64_t i = 0; i < count; ++i) index = get_bucket(in, index, buckets.emplace_back());
  return in.done();
}

void ArcListsView::unpack(std::size_t arc, std::vector<Bucket>& buckets) const {
  if (!unpack_buckets(of(arc), buckets)) throw std::logic_error("ArcListsView: a list cannot be read");
}

std::uint64_t packed_count(std::span<const std::byte> packed) {
  return packed.empty() ? 0 : ByteReader(packed).varint();
}

Bucket packed_end(std::span<const std::byte> packed, Direction d) {
  ByteReader in(packed);
  const std::uint64_t count = in.varint();
  Bucket bucket;
  std::int64_t index = get_bucket(in, 0, bucket);
  for (std::uint64_t i = 1; d == kUp && i < count && in.ok(); ++i) {
    bucket = {};
    index = get_bucket(in, index, bucket);
  }
  return bucket;
}

}  // namespace reeb
