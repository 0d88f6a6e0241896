#include "libreeb/hierarchy/bucket_lists.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb {
namespace {

// How many of the bucket's vertices are taken to lie below the cut.
std::uint64_t count_below(const Bucket& bucket, const CutValues& values, int exponent) {
  const auto index = static_cast<double>(bucket.index);
  const double bottom = std::max(values.lo, std::ldexp(index, exponent));
  const double top = std::min(values.hi, std::ldexp(index + 1, exponent));
  if (!(bottom < top)) return bucket.count;
  const double share = std::clamp((values.at - bottom) / (top - bottom), 0.0, 1.0);
  return std::min(bucket.count,
                  static_cast<std::uint64_t>(std::round(static_cast<double>(bucket.count) * share)));
}

}  // namespace

ArcBucketLists::ArcBucketLists(ArcBuckets buckets, std::size_t arcs, int exponent)
    : exponent_(exponent),
      at_first_(std::move(buckets)),
      first_(arcs, at_first_.view().empty() ? kNone : kAsAtFirst) {}

std::size_t ArcBucketLists::count(std::uint32_t arc) const {
  if (first_[arc] == kAsAtFirst) return at_first_.view().count(arc);
  std::size_t count = 0;
  for (std::uint32_t item = first_[arc]; item != kNone; item = items_[item].next) ++count;
  return count;
}

void ArcBucketLists::make_list(std::uint32_t arc) {
  if (first_[arc] != kAsAtFirst) return;
  first_[arc] = kNone;
  const auto own = at_first_.view().of(arc);
  for (auto bucket = own.rbegin(); bucket != own.rend(); ++bucket) first_[arc] = make(*bucket, first_[arc]);
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

// Puts a chain of items where they belong in a list.
void ArcBucketLists::insert(std::uint32_t chain, std::uint32_t into) {
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

void ArcBucketLists::add(std::uint32_t arc, double value, const std::array<double, 3>& position) {
  make_list(arc);
  insert(make({bucket_index(value, exponent_), 1, position}, kNone), arc);
}

// Divides the arc's bucket that the cut lies in, and returns the last item below the cut.
std::uint32_t ArcBucketLists::last_below(std::uint32_t arc, const CutValues& values) {
  const std::int64_t middle = bucket_index(values.at, exponent_);
  std::uint32_t before = kNone, item = first_[arc];
  while (item != kNone && items_[item].bucket.index < middle) {
    before = item;
    item = items_[item].next;
  }
  if (item == kNone || items_[item].bucket.index != middle) return before;

  Bucket upper = items_[item].bucket;
  const std::uint64_t below = count_below(upper, values, exponent_);
  if (below == 0) return before;
  if (below == upper.count) return item;
  upper.count -= below;
  const std::uint32_t above = make(upper, items_[item].next);
  items_[item].bucket.count = below;
  items_[item].next = above;
  return item;
}

bool ArcBucketLists::cut(Direction d, std::uint32_t from, std::uint32_t into, const CutValues& values) {
  make_list(from);
  make_list(into);
  if (first_[from] == kNone) return false;
  const std::uint32_t last = last_below(from, values);
  const std::uint32_t above = std::exchange(after(last, from), kNone);
  const std::uint32_t below = first_[from];
  first_[from] = d == kUp ? below : above;
  const std::uint32_t chain = d == kUp ? above : below;
  insert(chain, into);
  return chain != kNone;
}

bool ArcBucketLists::merge(std::uint32_t from, std::uint32_t into) {
  make_list(from);
  make_list(into);
  const std::uint32_t chain = std::exchange(first_[from], kNone);
  insert(chain, into);
  return chain != kNone;
}

std::uint64_t ArcBucketLists::drop(std::uint32_t arc) {
  make_list(arc);
  std::uint64_t count = 0;
  for (std::uint32_t item = std::exchange(first_[arc], kNone); item != kNone;) {
    count += items_[item].bucket.count;
    const std::uint32_t next = items_[item].next;
    free(item);
    item = next;
  }
  return count;
}

void ArcBucketLists::append_to(std::vector<Bucket>& out, std::uint32_t arc) const {
  if (first_[arc] == kAsAtFirst) {
    const auto own = at_first_.view().of(arc);
    out.insert(out.end(), own.begin(), own.end());
    return;
  }
  for (std::uint32_t item = first_[arc]; item != kNone; item = items_[item].next)
    out.push_back(items_[item].bucket);
}

}  // namespace reeb
