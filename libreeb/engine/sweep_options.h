// What a sweep does besides finding the graph.
#pragma once

#include <optional>

namespace reeb {

// Neither may decrease along a stream: the glue goes by the latest fragment.
struct SweepOptions {
  // Leaves of less persistence are removed where it is already sure that they are noise
  // (docs/SEMANTICS.md, Noise removal). What is not sure yet is left: a last pass over the whole graph finishes.
  double noise_below = 0;
  // Of the embedding's buckets; without it there are none.
  // REQUIRES: at least bucket_exponent() of a range with all values so far.
  std::optional<int> bucket_exponent = {};
};

}  // namespace reeb
