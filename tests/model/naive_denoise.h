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

}  // namespace reeb::test
