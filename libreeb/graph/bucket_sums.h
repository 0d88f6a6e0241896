// Exact sums of positions by buckets of function value, in lists (docs/SEMANTICS.md, Buckets).
//
// A sum does not depend on the order of additions: positions are clamped to +-2^50 and rounded to whole multiples of
// 2^-44, and are added in 128 bits, which is enough for 2^32 of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "libreeb/base/prefetch.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/base/vector3.h"
#include "libreeb/containers/growing_array.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/graph/direction.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/graph/settled_node.h"

namespace reeb {

__extension__ typedef __int128 Int128;

// A position with a squared length below this has coordinates that fit in 64 bits, in units of 2^-44.
inline constexpr double kSmallSquare = 0x1p36;

// A coordinate in units of 2^-44, rounded towards zero. A NaN counts as the least coordinate.
inline Int128 fixed_point(double x) {
  constexpr double kMaxCoordinate = 0x1p50;
  x = x > -kMaxCoordinate ? x : -kMaxCoordinate;
  x = x < kMaxCoordinate ? x : kMaxCoordinate;
  const auto whole = static_cast<std::int64_t>(x);
  const double rest = x - static_cast<double>(whole);
  return (static_cast<Int128>(whole) << 44) + static_cast<std::int64_t>(rest * 0x1p44);
}

// Conversions between whole numbers and doubles. Most numbers fit in 64 bits, which convert faster.
inline double to_double(Int128 whole) {
  const auto low = static_cast<std::int64_t>(whole);
  return low == whole ? static_cast<double>(low) : static_cast<double>(whole);
}
inline Int128 cut_off(double x) { return std::abs(x) < 0x1p63 ? static_cast<std::int64_t>(x) : static_cast<Int128>(x); }

// The moment, the sum of the squared positions, is rounded: whole numbers of a fixed unit would need more than 128
// bits, or be too coarse for small meshes. So its last digits depend on where chunks end.
//
// Adding to a bucket mostly waits for its memory. So the fields are in the order that leaves no gaps: 80 bytes.
struct BucketSum {
  std::int64_t index = 0;
  std::uint32_t count = 0;
  RimPoint rim = kNoRim;
  double moment = 0;
  std::array<Int128, 3> sum{};

  friend bool operator==(const BucketSum&, const BucketSum&) = default;

  static constexpr RimPoint kNoRim = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

  // REQUIRES: there are fewer than 2^32 - 1 vertices. A sweep adds those of a chunk only; elsewhere check_room() tells.
  void add(const Point& position) {
    ++count;
    const double square = dot(position, position);
    if (square < kSmallSquare) [[likely]] {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<std::int64_t>(position[k] * 0x1p44);
      moment += square;
      raise_rim(near_rim_of(position));
    } else {
      add_large(position);
    }
  }
  // THROWS: as check_room().
  void add(const BucketSum& other) {
    check_room(other.count);
    count += other.count;
    for (std::size_t k = 0; k < 3; ++k) sum[k] += other.sum[k];
    moment += other.moment;
    raise_rim(other.rim);
  }
  // THROWS: Error{kResource} if the bucket cannot count so many more vertices.
  void check_room(std::uint32_t more) const {
    if (more > ~count) [[unlikely]]
      refuse_vertices();
  }
  // Which vertex is next cannot be predicted, so only a tie in x takes a branch. Vertices that follow each other are
  // often of one bucket, and wait for these fields. So x is a maximum of its own, and y and z are replaced as one
  // number.
  void raise_rim(const RimPoint& other) {
    bool is_higher = other[0] > rim[0];
    if (other[0] == rim[0]) [[unlikely]]
      is_higher = other[1] > rim[1] || (other[1] == rim[1] && other[2] > rim[2]);
    const std::uint64_t replaced = is_higher ? ~std::uint64_t{0} : 0;
    rim[0] = std::max(rim[0], other[0]);
    std::uint64_t rest, other_rest;
    std::memcpy(&rest, &rim[1], sizeof rest);
    std::memcpy(&other_rest, &other[1], sizeof rest);
    rest ^= (rest ^ other_rest) & replaced;
    std::memcpy(&rim[1], &rest, sizeof rest);
  }
  void add_large(const Point& position);
  [[noreturn]] static void refuse_vertices();
  // Keeps this number of the vertices, with their share of the sum (rounded), and adds the rest to `other`. The totals
  // of both stay exact. Both get the rim. THROWS: as check_room().
  void keep(std::uint64_t kept, BucketSum& other);
  Bucket mean() const {  // REQUIRES: count != 0
    Bucket bucket{index, count, {}};
    for (std::size_t k = 0; k < 3; ++k) bucket.mean[k] = to_double(sum[k]) * 0x1p-44;
    if (count == 1) return bucket;  // the most frequent case where values are random
    for (double& x : bucket.mean) x /= static_cast<double>(count);
    const auto& [x, y, z] = bucket.mean;
    bucket.spread = to_spread(moment / static_cast<double>(count) - (x * x + y * y + z * z));
    bucket.rim = rim;
    return bucket;
  }
};

// Lists of buckets, ascending by index, in one pool, all of one exponent. Indices and links are used most, so they are
// in an array of their own, apart from the large sums.
class BucketLists {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = ~Index{0};

  struct List {
    Index last = kNone;  // its `next` is the first bucket
    bool empty() const { return last == kNone; }
  };

  // Forgets all lists; keeps the memory.
  void start(int exponent);
  int exponent() const { return indexer_.exponent(); }
  // Sets the exponent, and coarsens the lists to it: visit_lists(visit) calls visit(list) for each. O(buckets) if it
  // changes.
  // REQUIRES: these are all lists; the exponent is not less than before, unless all lists are empty.
  template <class VisitLists>
  void raise_exponent(int exponent, const VisitLists& visit_lists) {
    const int levels = exponent - indexer_.exponent();
    if (levels == 0) return;
    indexer_ = BucketIndexer(exponent);
    visit_lists([&](List& list) { coarsen(list, levels); });
  }

  // Makes the buckets 0, 1, ... (count - 1), for the vertices of a sweep. The caller sets their sums, and then links
  // each to the end of a list, or drops it. REQUIRES: no other bucket was made since start().
  std::span<BucketSum> make(std::size_t count);
  // REQUIRES: the list's last index < the bucket's.
  void link(List& list, Index b) {
    links_[b].index = sums_[b].index;
    link_last(list, b);
  }
  void drop(Index b) { free_bucket(b); }

  // Like all that add up buckets, these throw what BucketSum::check_room() does.
  //
  // Adds a vertex. O(1) at the list's ends.
  void add_vertex(List& list, double value, const Point& position);
  // Adds vertices of one bucket. O(1) at the list's ends.
  void add(List& list, const BucketSum& bucket);
  // REQUIRES: the list's last index <= this one.
  void append(List& list, const BucketSum& bucket);
  // Moves the buckets of `upper` to the end of `lower`. O(1).
  // REQUIRES: last index of `lower` <= first index of `upper`.
  void concatenate(List& lower, List& upper);
  // The same with a vertex between them.
  void concatenate(List& lower, double value, const Point& position, List& upper);
  // Moves the buckets of `from`, whatever their indices, to `into`.
  void merge(List& into, List& from);
  // Takes the buckets above the value `at` from a list that covers the values from lo to hi. The bucket that contains
  // `at` is divided in proportion to the value. If it has few vertices, it goes whole to the side with the greater part
  // of its values.
  List take_above(List& list, double lo, double at, double hi);
  // Moves what take_above takes to `into`, whose buckets are above `at`. O(1) if `from` is a single bucket.
  void move_above(List& from, double lo, double at, double hi, List& into);
  // Calls visit(bucket) for all buckets, ascending, and leaves the list empty.
  template <class Visit>
  void drain(List& list, const Visit& visit) {
    if (list.empty()) return;
    const Index first = links_[list.last].next;
    for (Index b = first;; b = links_[b].next) {
      visit(sums_[b]);
      free_bucket(b);
      if (b == list.last) break;
    }
    list.last = kNone;
  }

  // Packs the means of all buckets, as the list of the next arc in `lists`, and leaves the list empty.
  void drain_means(List& list, ArcLists& lists);

  // As drain(), and the list stays.
  template <class Visit>
  void visit(const List& list, const Visit& visit) const {
    if (list.empty()) return;
    Index b = list.last;
    do visit(sums_[b = links_[b].next]);
    while (b != list.last);
  }

  // Prefetches the last bucket of a list, which mostly is its only one.
  void prefetch(const List& list) const {
    if (list.empty()) return;
    reeb::prefetch(&links_[list.last]);
    reeb::prefetch(&sums_[list.last]);
    reeb::prefetch(&sums_[list.last].sum[2]);
  }

  std::size_t used() const { return sums_.size() - free_count_; }  // buckets
  // What they take in addition for this many more buckets.
  std::size_t growth_bytes(std::size_t buckets) const {
    return (buckets - std::min(buckets, free_count_)) * (sizeof(BucketSum) + sizeof(Link) + sizeof(Index));
  }
  std::size_t memory_bytes() const { return sums_.memory_bytes() + links_.memory_bytes() + free_.memory_bytes(); }
  void save(StateWriter& out) const;
  // THROWS: DamagedState, as check_restored(), which tells whether `lists` are lists of buckets that no other list and
  //         no free bucket shares.
  void restore(StateReader& in);
  void check_restored(std::span<const List> lists) const;

 private:
  struct Link {
    std::int64_t index;  // as in the sum
    Index next;          // in its list
  };

  Index new_bucket(const BucketSum& bucket);
  void free_bucket(Index b) { free_[free_count_++] = b; }
  void link_last(List& list, Index b);
  void link_or_add(List& list, Index b);
  void remove_first(List& list);
  void coarsen(List& list, int levels);
  void add_checked(Index bucket, const Point& position) {
    sums_[bucket].check_room(1);
    sums_[bucket].add(position);
  }
  List split_after(List& list, Index last_below);
  std::uint64_t count_above(Index bucket, double lo, double at, double hi) const;

  GrowingArray<BucketSum> sums_;
  GrowingArray<Link> links_;
  // The first free_count_ entries are the free buckets. Unlike a list through the free buckets, this names the next one
  // without reading a bucket.
  GrowingArray<Index> free_;
  std::size_t free_count_ = 0;
  BucketIndexer indexer_;
};

// The buckets of an arc of a path, and the value at the far end of the arc.
struct PathBuckets {
  BucketLists::List* list;
  double end;
};

// Moves the buckets of the arc between `saddle` and `leaf`, which is in direction d from it, to another path from the
// same saddle: each bucket to the arc that covers its values, the rest to the last arc.
void lay_on_path(BucketLists& lists, BucketLists::List& from, Direction d, double saddle, double leaf,
                 std::span<const PathBuckets> path);

}  // namespace reeb
