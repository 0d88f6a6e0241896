// Noise removal as DESIGN.md 1.6 words it, leaf by leaf on the exact graph.
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

// The same for large graphs, in rounds: what each node reaches is found anew, all leaves that are
// noise by it go at once, (1, 1) nodes disappear. (What a saddle reaches at the farthest reaches
// farthest from its own saddle too, so it never goes in the same round.) O(nodes + arcs) a round.
Denoised denoise_in_rounds(const ReebGraph& graph, double threshold);

}  // namespace reeb::test
