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

// A cut of an arc that spans the values from `lo` to `hi`, at the value `at`.
struct CutValues {
  double lo = 0, at = 0, hi = 0;
};

// Each arc has a list of buckets, ascending, one per index. Vertices that leave a list enter another one or are
// dropped, so no vertex is counted twice or lost.
//
// Lists are stored packed. An operation opens the lists that it changes: they become linked lists until close() packs
// them again. Until then closed() still returns the former list.
//
// TIME:   an operation walks the lists of its arcs once; close() walks the open lists once.
// MEMORY: PackedLists; 48 bytes per open bucket.
class ArcBucketLists {
 public:
  // REQUIRES: all buckets are of this exponent, and none is empty.
  ArcBucketLists(PackedLists lists, int exponent);

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
  // The link from the item to the next one, or from the arc to its first item.
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
  FlatMap open_;  // from arcs to their entries in opened_
  std::vector<Opened> opened_;
  std::vector<Item> items_;     // of opened lists
  std::uint32_t free_ = kNone;  // a list of unused items
  std::vector<Bucket> buckets_;
  std::vector<std::byte> bytes_;
};

}  // namespace reeb
