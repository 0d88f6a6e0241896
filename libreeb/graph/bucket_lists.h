// The embedding of a graph while its arcs are cut, merged and joined (docs/SEMANTICS.md, Buckets).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/containers/flat_map.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/graph/direction.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/graph/packed_lists.h"

namespace reeb {

// A cut of an arc that spans the values from `lo` to `hi`, at the value `at`.
struct CutValues {
  double lo = 0, at = 0, hi = 0;
};

// The values of a bucket that an arc spans, which has values from `lo` to `hi`.
struct BucketSpan {
  double bottom, top;
};
BucketSpan values_in_bucket(const Bucket& bucket, double lo, double hi, int exponent);

// The first value, in direction d, at which a cut finds vertices of the bucket before it. The arc spans the values from
// `lo` to `hi`.
double first_value_of(const Bucket& bucket, Direction d, double lo, double hi, int exponent);

// How many of the bucket's vertices count as below the cut.
std::uint64_t vertices_below(const Bucket& bucket, const CutValues& values, int exponent);

// Each arc has a list of buckets, ascending, one per index. Vertices that leave a list enter another one or are
// dropped, so no vertex is counted twice or lost.
//
// `Lists` stores them packed, as PackedLists does. An operation opens the lists that it changes: they become linked
// lists until close() packs them again. Until then closed() still returns the former list.
//
// TIME:   an operation walks the lists of its arcs once; close() walks the open lists once.
// MEMORY: PackedLists; 64 bytes per open bucket.
template <class Lists = PackedLists>
class BasicArcBucketLists {
 public:
  // REQUIRES: all buckets are of this exponent, and none is empty.
  BasicArcBucketLists(Lists lists, int exponent) : exponent_(exponent), packed_(std::move(lists)) {}

  std::size_t arc_count() const { return packed_.size(); }
  bool empty(ArcId arc) const {
    const std::uint32_t opened = open_.find(arc.value());
    return opened != kNone ? opened_[opened].first == kNone : packed_.of(arc.value()).empty();
  }

  // Prefetches where the arc's list is stored; when that has arrived, prefetch() fetches the list.
  void prefetch_place(ArcId arc) const { packed_.prefetch_place(arc.value()); }
  void prefetch(ArcId arc) const { packed_.prefetch(arc.value()); }

  // Adds a vertex to its bucket.
  void add(ArcId arc, double value, const std::array<double, 3>& position);

  // The arc spans the values from `lo` to `hi`. Returns the first value, in direction d, at which a cut finds vertices
  // before it. A cut at an earlier value moves nothing. REQUIRES: !empty(arc).
  double first_value(Direction d, ArcId arc, double lo, double hi);

  // Moves the vertices of `from` on side d of values.at to `into`. The bucket that contains the value is divided in
  // proportion to the values of the arc within it, in whole vertices; both parts keep its mean. Returns whether
  // anything moved.
  bool cut(Direction d, ArcId from, ArcId into, const CutValues& values);

  // Moves all buckets of `from` to `into`. Returns whether anything moved.
  bool merge(ArcId from, ArcId into);

  // Removes all vertices of the arc, and returns their number.
  std::uint64_t drop(ArcId arc);

  // Packs the open lists. Spans from closed() become invalid.
  void close();
  // The list of the arc at the last close(), packed.
  std::span<const std::byte> closed(ArcId arc) const { return packed_.of(arc.value()); }

  // Between hold() and release(), one thread may change lists while another one reads closed() of other arcs. REQUIRES:
  // at most this many lists are opened in between.
  void hold(std::size_t opened) { packed_.hold(opened_.size() + opened); }
  void release() { packed_.release(); }

  int exponent() const { return exponent_; }
  const Lists& packed() const { return packed_; }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Item {
    Bucket bucket;
    std::uint32_t next = kNone;
  };
  static_assert(sizeof(Item) == 64);  // as promised above
  struct Opened {
    ArcId arc;
    std::uint32_t first;
  };

  bool is_open(ArcId arc) const { return open_.find(arc.value()) != kNone; }
  std::uint32_t& first(ArcId arc) { return opened_[open_.find(arc.value())].first; }
  // The link from the item to the next one, or from the arc to its first item.
  std::uint32_t& after(std::uint32_t item, ArcId arc) { return item == kNone ? first(arc) : items_[item].next; }
  void open(ArcId arc);
  void open(ArcId arc, std::span<const Bucket> own);
  std::span<const Bucket> unpacked(ArcId arc);
  const Bucket& first_bucket(Direction d, ArcId arc);
  bool has_any_beyond(Direction d, std::span<const Bucket> own, const CutValues& values) const;
  std::uint32_t make(const Bucket& bucket, std::uint32_t next);
  void free(std::uint32_t item);
  void insert(std::uint32_t chain, ArcId into);
  std::uint32_t last_below(ArcId arc, const CutValues& values);

  int exponent_;
  Lists packed_;
  FlatMap open_;  // from arcs to their entries in opened_
  std::vector<Opened> opened_;
  std::vector<Item> items_;     // of opened lists
  std::uint32_t free_ = kNone;  // a list of unused items
  std::vector<Bucket> buckets_;
  std::vector<std::byte> bytes_;
};

using ArcBucketLists = BasicArcBucketLists<>;

template <class Lists>
void BasicArcBucketLists<Lists>::open(ArcId arc) {
  if (!is_open(arc)) open(arc, unpacked(arc));
}

// REQUIRES: the arc is not open, and this is its list.
template <class Lists>
void BasicArcBucketLists<Lists>::open(ArcId arc, std::span<const Bucket> own) {
  open_.find_or_insert(arc.value(), static_cast<std::uint32_t>(opened_.size()));
  opened_.push_back({arc, kNone});
  for (auto bucket = own.rbegin(); bucket != own.rend(); ++bucket) first(arc) = make(*bucket, first(arc));
}

// Valid until the next call.
template <class Lists>
std::span<const Bucket> BasicArcBucketLists<Lists>::unpacked(ArcId arc) {
  buckets_.clear();
  if (!unpack_buckets(packed_.of(arc.value()), buckets_))
    throw std::logic_error("ArcBucketLists: a list cannot be read");
  return buckets_;
}

template <class Lists>
void BasicArcBucketLists<Lists>::close() {
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

template <class Lists>
std::uint32_t BasicArcBucketLists<Lists>::make(const Bucket& bucket, std::uint32_t next) {
  if (free_ == kNone) {
    items_.push_back({bucket, next});
    return static_cast<std::uint32_t>(items_.size() - 1);
  }
  const std::uint32_t item = std::exchange(free_, items_[free_].next);
  items_[item] = {bucket, next};
  return item;
}

template <class Lists>
void BasicArcBucketLists<Lists>::free(std::uint32_t item) {
  items_[item].next = std::exchange(free_, item);
}

// Inserts a chain of items into a list, in order.
template <class Lists>
void BasicArcBucketLists<Lists>::insert(std::uint32_t chain, ArcId into) {
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

template <class Lists>
void BasicArcBucketLists<Lists>::add(ArcId arc, double value, const std::array<double, 3>& position) {
  open(arc);
  insert(make({bucket_index(value, exponent_), 1, position}, kNone), arc);
}

// Divides the bucket that contains the cut, and returns the last item below the cut.
template <class Lists>
std::uint32_t BasicArcBucketLists<Lists>::last_below(ArcId arc, const CutValues& values) {
  const std::int64_t middle = bucket_index(values.at, exponent_);
  std::uint32_t before = kNone, item = first(arc);
  while (item != kNone && items_[item].bucket.index < middle) {
    before = item;
    item = items_[item].next;
  }
  if (item == kNone || items_[item].bucket.index != middle) return before;

  const Bucket upper = items_[item].bucket;
  const std::uint64_t below = vertices_below(upper, values, exponent_);
  if (below == 0) return before;
  if (below == upper.count) return item;
  const std::uint32_t above = make(part_of(upper, upper.count - below), items_[item].next);
  items_[item].bucket = part_of(upper, below);
  items_[item].next = above;
  return item;
}

template <class Lists>
double BasicArcBucketLists<Lists>::first_value(Direction d, ArcId arc, double lo, double hi) {
  return first_value_of(first_bucket(d, arc), d, lo, hi, exponent_);
}

// The first bucket in direction d. Valid until the next call.
template <class Lists>
const Bucket& BasicArcBucketLists<Lists>::first_bucket(Direction d, ArcId arc) {
  if (!is_open(arc)) {
    const auto own = unpacked(arc);
    return d == kUp ? own.front() : own.back();
  }
  std::uint32_t item = first(arc);
  while (d == kDown && items_[item].next != kNone) item = items_[item].next;
  return items_[item].bucket;
}

template <class Lists>
bool BasicArcBucketLists<Lists>::cut(Direction d, ArcId from, ArcId into, const CutValues& values) {
  // Half of all cuts move nothing. A list that is not opened need not be packed and stored again.
  if (!is_open(from)) {
    const auto own = unpacked(from);
    if (!has_any_beyond(d, own, values)) return false;
    open(from, own);
  }
  const std::uint32_t last = last_below(from, values);
  const std::uint32_t above = std::exchange(after(last, from), kNone);
  const std::uint32_t below = first(from);
  first(from) = d == kUp ? below : above;
  const std::uint32_t chain = d == kUp ? above : below;
  if (chain == kNone) return false;
  open(into);
  insert(chain, into);
  return true;
}

// Whether a cut of this list finds vertices on side d.
template <class Lists>
bool BasicArcBucketLists<Lists>::has_any_beyond(Direction d, std::span<const Bucket> own,
                                                const CutValues& values) const {
  if (own.empty()) return false;
  const Bucket& farthest = d == kUp ? own.back() : own.front();
  const std::int64_t middle = bucket_index(values.at, exponent_);
  if (farthest.index != middle) return (farthest.index > middle) == (d == kUp);
  const std::uint64_t below = vertices_below(farthest, values, exponent_);
  return d == kUp ? below != farthest.count : below != 0;
}

template <class Lists>
bool BasicArcBucketLists<Lists>::merge(ArcId from, ArcId into) {
  if (empty(from)) return false;
  open(from);
  open(into);
  insert(std::exchange(first(from), kNone), into);
  return true;
}

template <class Lists>
std::uint64_t BasicArcBucketLists<Lists>::drop(ArcId arc) {
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
