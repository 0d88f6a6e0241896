#include "libreeb/hierarchy/bucket_lists.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "libreeb/graph/packed_buckets.h"

namespace reeb {
namespace {

struct Values {
  double bottom, top;
};

// The values of the bucket that the arc spans.
Values own_values(const Bucket& bucket, double lo, double hi, int exponent) {
  const auto index = static_cast<double>(bucket.index);
  return {std::max(lo, std::ldexp(index, exponent)), std::min(hi, std::ldexp(index + 1, exponent))};
}

// How many of the bucket's vertices count as below the cut.
std::uint64_t count_below(const Bucket& bucket, const CutValues& values, int exponent) {
  const auto [bottom, top] = own_values(bucket, values.lo, values.hi, exponent);
  if (!(bottom < top)) return bucket.count;
  const double share = std::clamp((values.at - bottom) / (top - bottom), 0.0, 1.0);
  return std::min(bucket.count, static_cast<std::uint64_t>(std::round(static_cast<double>(bucket.count) * share)));
}

}  // namespace

ArcBucketLists::ArcBucketLists(PackedLists lists, int exponent) : exponent_(exponent), packed_(std::move(lists)) {}

void ArcBucketLists::open(ArcId arc) {
  if (is_open(arc)) return;
  open_.find_or_insert(arc.value(), static_cast<std::uint32_t>(opened_.size()));
  opened_.push_back({arc, kNone});
  const auto own = unpacked(arc);
  for (auto bucket = own.rbegin(); bucket != own.rend(); ++bucket) first(arc) = make(*bucket, first(arc));
}

// Valid until the next call.
std::span<const Bucket> ArcBucketLists::unpacked(ArcId arc) {
  buckets_.clear();
  if (!unpack_buckets(packed_.of(arc.value()), buckets_))
    throw std::logic_error("ArcBucketLists: a list cannot be read");
  return buckets_;
}

void ArcBucketLists::close() {
  for (const Opened& opened : opened_) {
    buckets_.clear();
    for (std::uint32_t item = opened.first; item != kNone; item = items_[item].next)
      buckets_.push_back(items_[item].bucket);
    bytes_.clear();
    pack_buckets(buckets_, bytes_);
    packed_.replace(opened.arc.value(), bytes_);
    open_.erase(opened.arc.value());
  }
  opened_.clear();
  items_.clear();
  free_ = kNone;
  packed_.collect();
}

std::uint32_t ArcBucketLists::make(const Bucket& bucket, std::uint32_t next) {
  if (free_ == kNone) {
    items_.push_back({bucket, next});
    return static_cast<std::uint32_t>(items_.size() - 1);
  }
  const std::uint32_t item = std::exchange(free_, items_[free_].next);
  items_[item] = {bucket, next};
  return item;
}

void ArcBucketLists::free(std::uint32_t item) { items_[item].next = std::exchange(free_, item); }

// Inserts a chain of items into a list, in order.
void ArcBucketLists::insert(std::uint32_t chain, ArcId into) {
  std::uint32_t before = kNone;
  while (chain != kNone) {
    const Bucket& bucket = items_[chain].bucket;
    std::uint32_t next = after(before, into);
    while (next != kNone && items_[next].bucket.index < bucket.index) {
      before = next;
      next = items_[next].next;
    }
    const std::uint32_t rest = items_[chain].next;
    if (next != kNone && items_[next].bucket.index == bucket.index) {
      merge_into(items_[next].bucket, bucket);
      free(chain);
    } else {
      after(before, into) = chain;
      items_[chain].next = next;
    }
    chain = rest;
  }
}

void ArcBucketLists::add(ArcId arc, double value, const std::array<double, 3>& position) {
  open(arc);
  insert(make({bucket_index(value, exponent_), 1, position}, kNone), arc);
}

// Divides the bucket that contains the cut, and returns the last item below the cut.
std::uint32_t ArcBucketLists::last_below(ArcId arc, const CutValues& values) {
  const std::int64_t middle = bucket_index(values.at, exponent_);
  std::uint32_t before = kNone, item = first(arc);
  while (item != kNone && items_[item].bucket.index < middle) {
    before = item;
    item = items_[item].next;
  }
  if (item == kNone || items_[item].bucket.index != middle) return before;

  const Bucket upper = items_[item].bucket;
  const std::uint64_t below = count_below(upper, values, exponent_);
  if (below == 0) return before;
  if (below == upper.count) return item;
  const std::uint32_t above = make(part_of(upper, upper.count - below), items_[item].next);
  items_[item].bucket = part_of(upper, below);
  items_[item].next = above;
  return item;
}

double ArcBucketLists::first_value(Direction d, ArcId arc, double lo, double hi) {
  const Bucket& bucket = first_bucket(d, arc);
  const auto [bottom, top] = own_values(bucket, lo, hi, exponent_);
  if (!(bottom < top)) return bottom;
  const double half_a_vertex = 0.5 / static_cast<double>(bucket.count) * (top - bottom);
  return d == kUp ? bottom + half_a_vertex : top - half_a_vertex;
}

// The first bucket in direction d. Valid until the next call.
const Bucket& ArcBucketLists::first_bucket(Direction d, ArcId arc) {
  if (!is_open(arc)) {
    const auto own = unpacked(arc);
    return d == kUp ? own.front() : own.back();
  }
  std::uint32_t item = first(arc);
  while (d == kDown && items_[item].next != kNone) item = items_[item].next;
  return items_[item].bucket;
}

bool ArcBucketLists::cut(Direction d, ArcId from, ArcId into, const CutValues& values) {
  open(from);
  open(into);
  if (first(from) == kNone) return false;
  const std::uint32_t last = last_below(from, values);
  const std::uint32_t above = std::exchange(after(last, from), kNone);
  const std::uint32_t below = first(from);
  first(from) = d == kUp ? below : above;
  const std::uint32_t chain = d == kUp ? above : below;
  insert(chain, into);
  return chain != kNone;
}

bool ArcBucketLists::merge(ArcId from, ArcId into) {
  open(from);
  open(into);
  const std::uint32_t chain = std::exchange(first(from), kNone);
  insert(chain, into);
  return chain != kNone;
}

std::uint64_t ArcBucketLists::drop(ArcId arc) {
  open(arc);
  std::uint64_t count = 0;
  for (std::uint32_t item = std::exchange(first(arc), kNone); item != kNone;) {
    count += items_[item].bucket.count;
    const std::uint32_t next = items_[item].next;
    free(item);
    item = next;
  }
  return count;
}

}  // namespace reeb
