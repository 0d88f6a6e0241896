// The buckets of an arc that is cut again and again, from one end to the other: where the next cut finds vertices.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "libreeb/graph/bucket.h"
#include "libreeb/graph/direction.h"

namespace reeb {

// A copy of a list. Cutting it changes no list.
//
// TIME: start() reads the list; each bucket is passed once.
class RemainingBuckets {
 public:
  // Copies a packed list of this exponent, whose arc spans the values from `start` in direction d to `end`.
  void start(Direction d, double start, double end, std::span<const std::byte> packed, int exponent);
  bool empty() const { return buckets_.empty(); }

  // Removes what BasicArcBucketLists::cut() would move from the arc at this value. The arc starts there afterwards.
  void cut(double at);
  // As BasicArcBucketLists::first_value(). REQUIRES: !empty().
  double first_value() const;

 private:
  std::vector<Bucket> buckets_;  // the first one in direction d is the last
  Direction direction_ = kUp;
  double start_ = 0, end_ = 0;
  int exponent_ = 0;
};

}  // namespace reeb
