// The last pass of noise removal, on a stored graph (DESIGN.md 1.6, 4).
#pragma once

#include <cstdint>
#include <optional>

#include "ooc/stored_graph/graph_change.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

struct LastNoiseOptions {
  double threshold = 0;
  std::optional<int> bucket_exponent = {};  // without one there is no embedding
  std::uint64_t vertices = 0;               // all of the graph's are below; 0: unknown
  std::uint64_t part_bytes = 2 << 20;       // what is done at once at least, if there is so much
};

struct LastNoisePass {
  bool fits = true;
  std::uint64_t needed_bytes = 0;  // if it does not: enough, beside what is in use
  std::uint64_t removed_pairs = 0;
  std::optional<GraphChange> change;  // if there is anything to change
};

// What denoise() would do to the graph of a finished store, as a change of it: only what noise removal
// can look at (noise_scope.h) is ever in memory, and of that, where it is much, one part at a time. The
// store with the change has, to the bit, the arcs and buckets that denoise() leaves.
//
// Reads the stored arcs in the order in which they lie, without merging: first for short ones near
// extrema, then for the degrees of their ends. Where few arcs meet these, they are had at once. Else
// it reads for all arcs of the nodes in question; where these are much, for what belongs together, and
// then by parts, at most about forty times.
//
// TIME:   O(n), and O(k log k) for the k short arcs.
// MEMORY: reserved: three bits a vertex, if that is little beside the graph; up to 112 bytes a short arc
//         and 75 an end of one; then part_bytes, or a sixteenth of what all parts take, or the largest
//         set of nodes in the scope that arcs hold together; and the change: 70 bytes an arc and 52 a
//         node, and payloads.
// THROWS: Error{kResource} of the disk. That the budget does not suffice is in the result.
LastNoisePass run_last_noise_pass(SegmentStore& store, const LastNoiseOptions& options);

}  // namespace reeb::ooc
