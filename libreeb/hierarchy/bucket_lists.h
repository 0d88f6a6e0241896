// The embedding of a graph while its arcs are cut, laid together and joined (DESIGN.md 5).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/graph/bucket.h"
#include "libreeb/hierarchy/arc_buckets.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// An arc that is to be cut: `at` divides the values from `lo` to `hi` that it spans.
struct CutValues {
  double lo = 0, at = 0, hi = 0;
};

// A list of buckets an arc, ascending, one for each index. What leaves a list enters another, unless
// it is dropped, so the counts add up to the same at all times.
//
// An arc has what it had at first until an operation names it; only then a list is made of it.
//
// TIME:   an operation walks the lists that it names, once.
// MEMORY: `buckets`; 4 bytes an arc, and 48 a bucket in a list; what is freed is used again.
class ArcBucketLists {
 public:
  // REQUIRES: all buckets are of this exponent, and none is empty.
  ArcBucketLists(ArcBuckets buckets, std::size_t arcs, int exponent);

  bool empty(std::uint32_t arc) const { return count(arc) == 0; }
  // How many buckets the arc has.
  std::size_t count(std::uint32_t arc) const;

  // A vertex enters its bucket.
  void add(std::uint32_t arc, double value, const std::array<double, 3>& position);

  // What `from` has on side d of values.at goes to `into`. The bucket that the value lies in is
  // divided in proportion to the values of the arc within it, to whole vertices; both parts keep
  // its mean. Returns whether anything moved.
  bool cut(Direction d, std::uint32_t from, std::uint32_t into, const CutValues& values);

  // All that `from` has goes to `into`. Returns whether anything did.
  bool merge(std::uint32_t from, std::uint32_t into);

  // Forgets what the arc has, and returns how many vertices that was.
  std::uint64_t drop(std::uint32_t arc);

  void append_to(std::vector<Bucket>& out, std::uint32_t arc) const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0}, kAsAtFirst = kNone - 1;
  struct Item {
    Bucket bucket;
    std::uint32_t next = kNone;
  };

  // The link that leads on from the item, or to the first one of the arc.
  std::uint32_t& after(std::uint32_t item, std::uint32_t arc) {
    return item == kNone ? first_[arc] : items_[item].next;
  }
  void make_list(std::uint32_t arc);
  std::uint32_t make(const Bucket& bucket, std::uint32_t next);
  void free(std::uint32_t item);
  void insert(std::uint32_t chain, std::uint32_t into);
  std::uint32_t last_below(std::uint32_t arc, const CutValues& values);

  int exponent_;
  ArcBuckets at_first_;
  std::vector<std::uint32_t> first_;  // one entry an arc
  std::vector<Item> items_;
  std::uint32_t free_ = kNone;  // a list of unused items
};

}  // namespace reeb
