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
// MEMORY: PackedLists; 60 bytes per bucket that was opened since close().
template <class Lists = PackedLists>
class BasicArcBucketLists {
 public:
  // REQUIRES: all buckets are of this exponent, and none is empty.
  BasicArcBucketLists(Lists lists, int exponent) : index_of_(exponent), packed_(std::move(lists)) {}

  std::size_t arc_count() const { return packed_.size(); }
  bool empty(ArcId arc) const {
    const std::uint32_t list = opened(arc);
    return list != kNone ? opened_[list].first == kNone : packed_.of(arc.value()).empty();
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

  int exponent() const { return index_of_.exponent(); }
  const Lists& packed() const { return packed_; }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Opened {
    ArcId arc;
    std::uint32_t first;
  };

  // The entry of an arc in opened_, or kNone; and that of an arc that is opened if it is not.
  std::uint32_t opened(ArcId arc) const { return open_.find(arc.value()); }
  std::uint32_t open(ArcId arc);
  std::uint32_t& first(std::uint32_t list) { return opened_[list].first; }
  // The link from the bucket to the next one, or from the list to its first bucket.
  std::uint32_t& after(std::uint32_t bucket, std::uint32_t list) {
    return bucket == kNone ? first(list) : next_[bucket];
  }
  Bucket first_bucket(Direction d, ArcId arc);
  bool is_any_beyond(Direction d, ArcId arc, const CutValues& values) const;
  std::uint32_t make(const Bucket& bucket, std::uint32_t next);
  void insert(std::uint32_t chain, std::uint32_t into);
  std::uint32_t last_below(std::uint32_t list, const CutValues& values);

  BucketIndexer index_of_;
  Lists packed_;
  FlatMap open_;  // from arcs to their entries in opened_
  std::vector<Opened> opened_;
  std::vector<Bucket> buckets_;      // of opened lists
  std::vector<std::uint32_t> next_;  // by bucket: the one after it in its list, or kNone
  std::vector<std::byte> bytes_;     // of close()
};

using ArcBucketLists = BasicArcBucketLists<>;

template <class Lists>
std::uint32_t BasicArcBucketLists<Lists>::open(ArcId arc) {
  const auto begin = static_cast<std::uint32_t>(buckets_.size()),
             next_list = static_cast<std::uint32_t>(opened_.size());
  if (const std::uint32_t list = open_.find_or_insert(arc.value(), next_list); list != next_list) return list;
  if (!unpack_buckets(packed_.of(arc.value()), buckets_))
    throw std::logic_error("ArcBucketLists: a list cannot be read");
  const auto end = static_cast<std::uint32_t>(buckets_.size());
  for (std::uint32_t next = begin; next < end;) next_.push_back(++next);
  if (begin < end) next_.back() = kNone;
  opened_.push_back({arc, begin < end ? begin : kNone});
  return next_list;
}

template <class Lists>
void BasicArcBucketLists<Lists>::close() {
  for (const Opened& opened : opened_) {
    std::size_t count = 0;
    for (std::uint32_t bucket = opened.first; bucket != kNone; bucket = next_[bucket]) ++count;
    if (bytes_.size() < most_packed_bytes(count)) bytes_.resize(most_packed_bytes(count));
    BucketPacker packer(count, bytes_.data());
    for (std::uint32_t bucket = opened.first; bucket != kNone; bucket = next_[bucket]) packer.add(buckets_[bucket]);
    packed_.replace(opened.arc.value(), {bytes_.data(), packer.end()});
    open_.erase(opened.arc.value());
  }
  opened_.clear();
  buckets_.clear();
  next_.clear();
  packed_.collect();
}

template <class Lists>
std::uint32_t BasicArcBucketLists<Lists>::make(const Bucket& bucket, std::uint32_t next) {
  buckets_.push_back(bucket);
  next_.push_back(next);
  return static_cast<std::uint32_t>(buckets_.size() - 1);
}

// Inserts a chain of buckets into a list, in order.
template <class Lists>
void BasicArcBucketLists<Lists>::insert(std::uint32_t chain, std::uint32_t into) {
  std::uint32_t before = kNone;
  while (chain != kNone) {
    const std::int64_t index = buckets_[chain].index;
    std::uint32_t next = after(before, into);
    while (next != kNone && buckets_[next].index < index) {
      before = next;
      next = next_[next];
    }
    const std::uint32_t rest = next_[chain];
    if (next != kNone && buckets_[next].index == index) {
      merge_into(buckets_[next], buckets_[chain]);
    } else {
      after(before, into) = chain;
      next_[chain] = next;
    }
    chain = rest;
  }
}

template <class Lists>
void BasicArcBucketLists<Lists>::add(ArcId arc, double value, const std::array<double, 3>& position) {
  const std::uint32_t list = open(arc);
  insert(make({index_of_(value), 1, position}, kNone), list);
}

// Divides the bucket that contains the cut, and returns the last bucket below the cut.
template <class Lists>
std::uint32_t BasicArcBucketLists<Lists>::last_below(std::uint32_t list, const CutValues& values) {
  const std::int64_t middle = index_of_(values.at);
  std::uint32_t before = kNone, bucket = first(list);
  while (bucket != kNone && buckets_[bucket].index < middle) {
    before = bucket;
    bucket = next_[bucket];
  }
  if (bucket == kNone || buckets_[bucket].index != middle) return before;

  const Bucket whole = buckets_[bucket];
  const std::uint64_t below = vertices_below(whole, values, exponent());
  if (below == 0) return before;
  if (below == whole.count) return bucket;
  next_[bucket] = make(part_of(whole, whole.count - below), next_[bucket]);
  buckets_[bucket] = part_of(whole, below);
  return bucket;
}

template <class Lists>
double BasicArcBucketLists<Lists>::first_value(Direction d, ArcId arc, double lo, double hi) {
  return first_value_of(first_bucket(d, arc), d, lo, hi, exponent());
}

// The first bucket in direction d.
template <class Lists>
Bucket BasicArcBucketLists<Lists>::first_bucket(Direction d, ArcId arc) {
  const std::uint32_t list = opened(arc);
  if (list == kNone) return packed_end(packed_.of(arc.value()), opposite(d));
  std::uint32_t bucket = first(list);
  while (d == kDown && next_[bucket] != kNone) bucket = next_[bucket];
  return buckets_[bucket];
}

template <class Lists>
bool BasicArcBucketLists<Lists>::cut(Direction d, ArcId from, ArcId into, const CutValues& values) {
  // Half of all cuts move nothing. A list that is not opened need not be packed and stored again.
  std::uint32_t list = opened(from);
  if (list == kNone) {
    if (!is_any_beyond(d, from, values)) return false;
    list = open(from);
  }
  const std::uint32_t last = last_below(list, values);
  const std::uint32_t above = std::exchange(after(last, list), kNone);
  const std::uint32_t below = first(list);
  first(list) = d == kUp ? below : above;
  const std::uint32_t chain = d == kUp ? above : below;
  if (chain == kNone) return false;
  insert(chain, open(into));
  return true;
}

// Whether a cut of the arc finds vertices on side d. REQUIRES: it is not open.
template <class Lists>
bool BasicArcBucketLists<Lists>::is_any_beyond(Direction d, ArcId arc, const CutValues& values) const {
  const auto packed = packed_.of(arc.value());
  if (packed.empty()) return false;
  const Bucket farthest = packed_end(packed, d);
  const std::int64_t middle = index_of_(values.at);
  if (farthest.index != middle) return (farthest.index > middle) == (d == kUp);
  const std::uint64_t below = vertices_below(farthest, values, exponent());
  return d == kUp ? below != farthest.count : below != 0;
}

template <class Lists>
bool BasicArcBucketLists<Lists>::merge(ArcId from, ArcId into) {
  if (empty(from)) return false;
  const std::uint32_t list = open(from), target = open(into);
  insert(std::exchange(first(list), kNone), target);
  return true;
}

template <class Lists>
std::uint64_t BasicArcBucketLists<Lists>::drop(ArcId arc) {
  std::uint64_t count = 0;
  for (std::uint32_t bucket = std::exchange(first(open(arc)), kNone); bucket != kNone; bucket = next_[bucket])
    count += buckets_[bucket].count;
  return count;
}

}  // namespace reeb
