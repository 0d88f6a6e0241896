// The embedding of an array of arcs: the buckets of each, one arc after the other (docs/SEMANTICS.md, Buckets).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/bucket.h"

namespace reeb {

// A view; empty where there is no embedding.
struct ArcBucketsView {
  std::span<const std::uint64_t> offsets;  // arc i owns buckets[offsets[i]] .. [offsets[i + 1])
  std::span<const Bucket> buckets;

  bool empty() const { return offsets.empty(); }
  std::size_t count(std::size_t arc) const { return empty() ? 0 : offsets[arc + 1] - offsets[arc]; }
  std::span<const Bucket> of(std::size_t arc) const {
    return empty() ? buckets : buckets.subspan(offsets[arc], count(arc));
  }
};

// Owns what a view shows. `offsets` has one entry more than there are arcs, or is empty.
struct ArcBuckets {
  std::vector<std::uint64_t> offsets;
  std::vector<Bucket> buckets;
  ArcBucketsView view() const { return {offsets, buckets}; }
};

}  // namespace reeb
