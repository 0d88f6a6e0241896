// The last pass of noise removal, on a stored graph (docs/SEMANTICS.md, Noise removal).
#pragma once

#include <cstdint>
#include <optional>

#include "io/file/temp_dir.h"
#include "ooc/stored_graph/graph_change.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

struct LastNoiseOptions {
  double threshold = 0;
  std::optional<int> bucket_exponent = {};  // without one there is no embedding
  std::uint64_t vertices = 0;               // all vertices of the graph are below this; 0: unknown
  std::uint64_t part_bytes = 2 << 20;       // least memory for the work on one part, if there is that much
  std::uint64_t change_bytes = 1 << 20;     // of the budget, to collect the arcs of the change
};

struct LastNoisePass {
  bool fits = true;
  std::uint64_t needed_bytes = 0;  // if it does not fit: this much would be enough, in addition to the memory in use
  std::uint64_t removed_pairs = 0;
  std::optional<GraphChange> change;  // set if there is anything to change
};

// Does to the graph of a finished store what denoise() does, but returns it as a change. Only what noise removal can
// touch (noise_scope.h) is ever in memory; if that is large, one part at a time. The store with the change has exactly,
// to the bit, the arcs and buckets that denoise() leaves.
//
// Reads the stored arcs as they are stored, without merging: first to find short arcs near extrema, then to find the
// degrees of their ends. If few arcs meet these ends, the second reading also keeps them. Else a third reading gathers
// all arcs of the nodes in question. If these are too many, it determines which belong together, and further readings
// take one part at a time, at most about forty times.
//
// TIME: O(n), and O(k log k) for the k short arcs.
// MEMORY: reserved: three bits per vertex, if that is little compared with the graph; up to 112 bytes per short arc and
//         75 per end of one; then part_bytes, or a sixteenth of what all parts take, or the largest set of nodes in the
//         scope that arcs connect; and the change: 52 bytes per node, and change_bytes for its arcs, the rest of which
//         is on disk.
// REQUIRES: `store` and `temp` outlive the change.
// THROWS: Error{kResource} of the disk. If the budget does not suffice, the result says so.
LastNoisePass run_last_noise_pass(SegmentStore& store, const io::TempDir& temp, const LastNoiseOptions& options);

}  // namespace reeb::ooc
