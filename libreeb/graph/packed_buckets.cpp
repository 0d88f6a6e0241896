#include "libreeb/graph/packed_buckets.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "libreeb/base/byte_coding.h"

namespace reeb {
namespace {

using Single = std::array<float, 3>;
static_assert(kLeastPackedBucketBytes == 2 + sizeof(Single));

constexpr std::size_t kMaxVarintBytes = 10, kMaxBucketBytes = 2 * kMaxVarintBytes + sizeof(Bucket::mean) +
                                                              sizeof(Bucket::spread) + sizeof(Bucket::rim);

bool is_single(const std::array<double, 3>& mean) {
  return std::ranges::all_of(mean, [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
}

std::byte* put_varint(std::byte* to, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) *to++ = static_cast<std::byte>(value | 0x80);
  *to++ = static_cast<std::byte>(value);
  return to;
}

template <class T>
std::byte* put_raw(std::byte* to, const T& value) {
  std::memcpy(to, &value, sizeof(value));
  return to + sizeof(value);
}

template <class T>
T get_raw(ByteReader& in) {
  T value{};
  const auto bytes = in.bytes(sizeof(T));
  if (!bytes.empty()) std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

}  // namespace

void pack_buckets(std::span<const Bucket> buckets, std::vector<std::byte>& packed) {
  if (buckets.empty()) return;
  std::array<std::byte, kMaxVarintBytes + kMaxBucketBytes> bytes;
  std::byte* to = put_varint(bytes.data(), buckets.size());
  std::int64_t last = 0;
  for (const Bucket& bucket : buckets) {
    const bool single = is_single(bucket.mean);
    to = put_varint(to, zigzag(static_cast<std::uint64_t>(bucket.index - last)));
    to = put_varint(to, bucket.count << 1 | (single ? 1 : 0));
    const auto& [x, y, z] = bucket.mean;
    to = single ? put_raw(to, Single{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)})
                : put_raw(to, bucket.mean);
    if (bucket.count > 1) to = put_raw(put_raw(to, bucket.spread), bucket.rim);
    packed.insert(packed.end(), bytes.data(), to);
    to = bytes.data();
    last = bucket.index;
  }
}

bool unpack_buckets(std::span<const std::byte> packed, std::vector<Bucket>& buckets) {
  if (packed.empty()) return true;
  ByteReader in(packed);
  const std::uint64_t count = in.varint();
  if (!in.may_hold(count, kLeastPackedBucketBytes)) return false;
  std::uint64_t index = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    // In place, since copying a bucket whose parts were just stored waits for these stores.
    Bucket& bucket = buckets.emplace_back();
    index = in.delta(index);
    bucket.index = static_cast<std::int64_t>(index);
    const std::uint64_t count_and_form = in.varint();
    bucket.count = count_and_form >> 1;
    if ((count_and_form & 1) == 0)
      bucket.mean = get_raw<std::array<double, 3>>(in);
    else
      std::ranges::copy(get_raw<Single>(in), bucket.mean.begin());
    if (bucket.count > 1) {
      bucket.spread = get_raw<float>(in);
      bucket.rim = get_raw<RimPoint>(in);
    }
  }
  return in.done();
}

std::uint64_t packed_count(std::span<const std::byte> packed) {
  return packed.empty() ? 0 : ByteReader(packed).varint();
}

}  // namespace reeb
