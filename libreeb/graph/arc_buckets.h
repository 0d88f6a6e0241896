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

// The same, with each list as bytes (packed_buckets.h). It takes a quarter of the memory.
struct ArcListsView {
  std::span<const std::uint64_t> ends;  // the list of arc i is bytes[ends[i - 1]] .. [ends[i]); that of arc 0, from 0
  std::span<const std::byte> bytes;

  bool empty() const { return ends.empty(); }
  std::span<const std::byte> of(std::size_t arc) const {
    if (empty()) return {};
    const std::size_t begin = arc == 0 ? 0 : ends[arc - 1];
    return bytes.subspan(begin, ends[arc] - begin);
  }
  // Appends the buckets of the arc.
  void unpack(std::size_t arc, std::vector<Bucket>& buckets) const;
};

}  // namespace reeb
