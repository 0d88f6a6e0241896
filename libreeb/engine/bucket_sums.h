// Exact sums of positions by buckets of function value, in lists (DESIGN.md 5).
//
// A sum does not depend on the order in which it is added up: positions are whole numbers of
// 2^-44, clamped to +-2^50 and added in 128 bits, which hold 2^32 of them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "libreeb/base/direction.h"
#include "libreeb/base/growing_array.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

__extension__ typedef __int128 Int128;

// In units of 2^-44 a coordinate below this is a 64-bit number.
inline constexpr double kSmallCoordinate = 0x1p18;

// A coordinate in units of 2^-44, cut off towards zero; what is no number is the least.
inline Int128 fixed_point(double x) {
  constexpr double kMost = 0x1p50;
  x = x > -kMost ? x : -kMost;
  x = x < kMost ? x : kMost;
  const auto whole = static_cast<std::int64_t>(x);
  const double rest = x - static_cast<double>(whole);
  return (static_cast<Int128>(whole) << 44) + static_cast<std::int64_t>(rest * 0x1p44);
}

struct BucketSum {
  std::int64_t index = 0;
  std::uint64_t count = 0;
  std::array<Int128, 3> sum{};

  void add(const Point& position) {
    ++count;
    const auto& [x, y, z] = position;
    if (std::abs(x) + std::abs(y) + std::abs(z) < kSmallCoordinate) [[likely]]
      for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<std::int64_t>(position[k] * 0x1p44);
    else
      for (std::size_t k = 0; k < 3; ++k) sum[k] += fixed_point(position[k]);
  }
  void add(const BucketSum& other) {
    count += other.count;
    for (std::size_t k = 0; k < 3; ++k) sum[k] += other.sum[k];
  }
  // Takes so many of the vertices out, with their share of the sum, or nearly; nothing is lost.
  BucketSum take(std::uint64_t taken);
  Bucket mean() const;
};

// Lists of buckets, ascending by index, in one pool. Each list has the exponent of its last change
// and is brought up to that of the pool before the next.
class BucketLists {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = ~Index{0};

  struct List {
    Index last = kNone;  // whose next one is the first
    std::int32_t exponent = 0;
    bool empty() const { return last == kNone; }
  };

  // Forgets all lists; keeps the memory.
  void start(int exponent);
  // REQUIRES: not less than before.
  void raise_exponent(int exponent) { exponent_ = exponent; }
  int exponent() const { return exponent_; }
  std::int64_t index_of(double value) const { return bucket_index(value, exponent_); }

  // For a sweep: all vertices up to the next call are in the bucket of this index, which is not less
  // than before. REQUIRES, for as long as vertices are added by bucket_at_hand: no other change.
  void start_bucket(std::int64_t index) {
    index_at_hand_ = index;
    first_at_hand_ = static_cast<Index>(sums_.size());
  }
  // That bucket of the list, to which vertices can be added at any later time.
  Index bucket_at_hand(List& list) {
    const Index made = static_cast<Index>(sums_.size()) - first_at_hand_;
    if (list.last - first_at_hand_ >= made) append_bucket(list, {index_at_hand_, 0, {}});
    return list.last;
  }
  void add_to_bucket(Index bucket, const Point& position) { sums_[bucket].add(position); }

  // Adds a vertex to the last bucket. REQUIRES: the list is of the pool's exponent, or empty; its
  // last index <= index.
  void add_last(List& list, std::int64_t index, const Point& position) {
    if (list.empty() || sums_[list.last].index != index) append_bucket(list, {index, 0, {}});
    sums_[list.last].add(position);
  }
  // The same for any list and value. O(1) at the list's ends.
  void add_vertex(List& list, double value, const Point& position);
  // REQUIRES: of the pool's exponent; the list is of that, or empty; its last index <= this one.
  void append(List& list, const BucketSum& bucket);
  // Moves the buckets of `upper` behind those of `lower`. O(1) where both are up to date.
  // REQUIRES: last index of `lower` <= first index of `upper`.
  void concatenate(List& lower, List& upper);
  // Moves the buckets of `from`, whichever they are, to `into`.
  void merge(List& into, List& from);
  // Of buckets that lie between the values lo and hi, takes those above `at`. The one that `at`
  // divides is divided in proportion to the value.
  List take_above(List& list, double lo, double at, double hi);
  // Calls visit(bucket) for all buckets, ascending, and forgets them.
  template <class Visit>
  void drain(List& list, const Visit& visit) {
    if (list.empty()) return;
    bring_up(list);
    const Index first = next_[list.last];
    for (Index b = first;; b = next_[b]) {
      visit(sums_[b]);
      if (b == list.last) break;
    }
    next_[list.last] = first_free_;
    first_free_ = first;
    list.last = kNone;
  }

  std::size_t memory_bytes() const {
    return sums_.memory_bytes() + next_.memory_bytes();
  }
  void save(StateWriter& out) const;
  void restore(StateReader& in);

 private:
  Index new_bucket(const BucketSum& bucket);
  void free_bucket(Index b);
  void link_last(List& list, Index b);
  void link_or_add(List& list, Index b);
  void append_bucket(List& list, const BucketSum& bucket);
  void remove_first(List& list);
  void bring_up(List& list) {
    if (list.exponent != exponent_) coarsen(list);
  }
  void coarsen(List& list);
  std::uint64_t count_above(const BucketSum& bucket, double lo, double at, double hi) const;

  GrowingArray<BucketSum> sums_;
  GrowingArray<Index> next_;  // in its list, or of free buckets
  Index first_free_ = kNone;
  int exponent_ = 0;
  std::int64_t index_at_hand_ = 0;
  Index first_at_hand_ = 0;  // buckets from here on are of that index
};

// An arc of a path, from its beginning, and the value at its far end.
struct PathBuckets {
  BucketLists::List* list;
  double end;
};

// Moves the buckets of the arc from `saddle` in direction d to `leaf` onto another path from the
// same saddle, each to the arc that covers its values, all that is left to the last arc.
void lay_on_path(BucketLists& lists, BucketLists::List& from, Direction d, double saddle,
                 double leaf, std::span<const PathBuckets> path);

}  // namespace reeb
