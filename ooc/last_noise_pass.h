// The last pass of noise removal, on a stored graph (DESIGN.md 1.6, 4).
#pragma once

#include <cstdint>
#include <optional>

#include "ooc/graph_patch.h"
#include "ooc/segment_store.h"

namespace reeb::ooc {

struct LastNoisePass {
  bool fits = true;
  std::uint64_t needed_bytes = 0;  // if it does not, with what there is in the store: enough
  std::uint64_t removed_pairs = 0;
  std::optional<GraphPatch> patch;  // nothing to be done without one
};

// What denoise() would do to the graph of a finished store, as a patch of it: only what noise removal
// can look at (noise_scope.h) is ever in memory. The store with the patch has, to the bit, the arcs
// and buckets that denoise() leaves. Without an exponent there is no embedding.
//
// Reads the stored arcs up to three times in the order in which they lie, without merging: first for
// short ones, then for the degrees of their ends, then for all arcs of the nodes in question.
//
// TIME:   O(n), and O(k log k) for the k short arcs.
// MEMORY: reserved: up to 136 bytes a short arc; then 160 an arc and 92 a node in the scope, and its
//         buckets.
// THROWS: Error{kResource} of the disk. That the budget does not suffice is in the result.
LastNoisePass run_last_noise_pass(SegmentStore& store, double threshold, std::optional<int> bucket_exponent);

}  // namespace reeb::ooc
