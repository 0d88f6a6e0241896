// Extended persistence by reducing the boundary matrix of the ascending and descending cone filtration, modulo 2
// (Agarwal, Edelsbrunner, Harer, Wang 2004; docs/SEMANTICS.md, Pairs). Cubic, and independent of the second stage.
#pragma once

#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "tests/support/inputs/complex.h"

namespace reeb::test {

// All pairs, sorted by type, lo, hi; a node of higher degree occurs several times.
std::vector<PersistencePair> reference_pairs(const ReebGraph& graph);

// A pair by its type and its two vertices, for graphs whose nodes are not numbered.
struct VertexPair {
  PairType type;
  VertexId lo, hi;
  friend auto operator<=>(const VertexPair&, const VertexPair&) = default;
};
std::vector<VertexPair> vertex_pairs(const ReebGraph& graph,
                                     const std::vector<PersistencePair>& pairs);  // sorted

// The same pairs from the complex itself, without its Reeb graph. Of the pairs of its 2-skeleton, these are all of
// dimension 0, and of dimension 1 the relative ones and the extended ones with lo below hi.
std::vector<VertexPair> reference_pairs(const Complex& complex);  // sorted

}  // namespace reeb::test
