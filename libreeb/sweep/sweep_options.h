// What a sweep does in addition to finding the graph.
#pragma once

#include <optional>

namespace reeb {

// The threshold of noise often rises with the range of the function. What is noted for a threshold holds up to this
// multiple of it.
inline constexpr double kNoiseAhead = 2;

// The first two options may not decrease along a stream: the glue uses those of the latest fragment.
struct SweepOptions {
  // Leaves of less persistence are removed as soon as they are certain to be noise (docs/SEMANTICS.md, Noise removal).
  // A last pass over the whole graph removes the others.
  double noise_below = 0;
  // The exponent of the embedding's buckets; without it there is no embedding.
  // REQUIRES: at least bucket_exponent() of a range with all values so far.
  std::optional<int> bucket_exponent = {};
  // The fragment lists its regular vertices, each with its arc. REQUIRES: no noise is removed.
  bool follows_vertices = false;
  // The path of an edge is dropped after its second triangle; a third one is an Error{kNotManifold}. A listed edge and
  // a degenerate triangle count as triangles at their edge.
  bool manifold = false;

  // Whether a sweep notes on which arc a regular vertex is.
  bool notes_regular() const { return bucket_exponent || follows_vertices; }
};

}  // namespace reeb
