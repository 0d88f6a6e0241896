// Noise removal straight from its definition (docs/SEMANTICS.md, Noise removal), leaf by leaf on the exact graph.
#pragma once

#include <cstdint>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::test {

struct Denoised {
  ReebGraph graph;
  std::uint64_t removed_pairs = 0;
};

// The result does not depend on the order in which leaves are removed; `seed` chooses one.
Denoised naive_denoise(const ReebGraph& graph, double threshold, std::uint64_t seed = 0);

// The same for large graphs, in rounds: find how far each node reaches, remove all leaves that are noise by that, and
// contract (1, 1) nodes. (The farthest extremum that a saddle reaches is never removed in the same round, since it is
// also the farthest from its own saddle.) O(nodes + arcs) per round.
Denoised denoise_in_rounds(const ReebGraph& graph, double threshold);

}  // namespace reeb::test
