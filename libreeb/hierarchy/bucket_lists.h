// The embedding of a graph while its arcs are cut, merged and joined (docs/SEMANTICS.md, Buckets).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/direction.h"
#include "libreeb/base/flat_map.h"
#include "libreeb/base/ids.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/hierarchy/packed_lists.h"

namespace reeb {

// An arc that is to be cut: `at` divides the values from `lo` to `hi` that it spans.
struct CutValues {
  double lo = 0, at = 0, hi = 0;
};

// A list of buckets an arc, ascending, one for each index. What leaves a list enters another, unless
// it is dropped, so the counts add up to the same at all times.
//
// Lists are kept packed. An operation opens those that it changes: they become linked lists, until
// close() packs them again. What an arc had when that was done last stays at hand meanwhile.
//
// TIME:   an operation walks the lists that it names, once; so does close().
// MEMORY: PackedLists; 48 bytes a bucket that is open.
class ArcBucketLists {
 public:
  // REQUIRES: all buckets are of this exponent, and none is empty.
  ArcBucketLists(PackedLists lists, int exponent);

  std::size_t arc_count() const { return packed_.size(); }
  bool empty(ArcId arc) const {
    const std::uint32_t opened = open_.find(arc.value());
    return opened != kNone ? opened_[opened].first == kNone : packed_.of(arc.value()).empty();
  }

  // Fetches into the caches, without waiting: where the arc's list is; and, when that was fetched, the list.
  void prefetch_place(ArcId arc) const { packed_.prefetch_place(arc.value()); }
  void prefetch(ArcId arc) const { packed_.prefetch(arc.value()); }

  // A vertex enters its bucket.
  void add(ArcId arc, double value, const std::array<double, 3>& position);

  // Up to which value, going along an arc that spans the values from `lo` to `hi`, a cut moves nothing of
  // what lies before it. REQUIRES: !empty(arc).
  double first_value(Direction d, ArcId arc, double lo, double hi);

  // What `from` has on side d of values.at goes to `into`. The bucket that the value lies in is
  // divided in proportion to the values of the arc within it, to whole vertices; both parts keep
  // its mean. Returns whether anything moved.
  bool cut(Direction d, ArcId from, ArcId into, const CutValues& values);

  // All that `from` has goes to `into`. Returns whether anything did.
  bool merge(ArcId from, ArcId into);

  // Forgets what the arc has, and returns how many vertices that was.
  std::uint64_t drop(ArcId arc);

  // Packs what was opened. Spans of closed() end here.
  void close();
  // What the arc had at the last close(), packed.
  std::span<const std::byte> closed(ArcId arc) const { return packed_.of(arc.value()); }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Item {
    Bucket bucket;
    std::uint32_t next = kNone;
  };
  struct Opened {
    ArcId arc;
    std::uint32_t first;
  };

  bool is_open(ArcId arc) const { return open_.find(arc.value()) != kNone; }
  std::uint32_t& first(ArcId arc) { return opened_[open_.find(arc.value())].first; }
  // The link that leads on from the item, or to the first one of the arc.
  std::uint32_t& after(std::uint32_t item, ArcId arc) { return item == kNone ? first(arc) : items_[item].next; }
  void open(ArcId arc);
  std::span<const Bucket> unpacked(ArcId arc);
  const Bucket& first_bucket(Direction d, ArcId arc);
  std::uint32_t make(const Bucket& bucket, std::uint32_t next);
  void free(std::uint32_t item);
  void insert(std::uint32_t chain, ArcId into);
  std::uint32_t last_below(ArcId arc, const CutValues& values);

  int exponent_;
  PackedLists packed_;
  FlatMap open_;  // of arcs, their entries in opened_
  std::vector<Opened> opened_;
  std::vector<Item> items_;     // of opened lists
  std::uint32_t free_ = kNone;  // a list of unused items
  std::vector<Bucket> buckets_;
  std::vector<std::byte> bytes_;
};

}  // namespace reeb
