// A change of a stored graph that is made while the graph is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/arc_buckets.h"
#include "ooc/node_table.h"

namespace reeb::ooc {

// Consecutive arcs with their buckets, all of one exponent.
struct ArcPiece {
  std::vector<ArcKeys> arcs;
  ArcBuckets buckets;  // without offsets where none are wanted
};

struct GraphPatch {
  Reservation memory;
  std::vector<SweepKey> redone;  // ascending: nodes of which no stored arc stays
  std::vector<SweepKey> gone;    // ascending: those of them that do not stay either
  std::uint64_t replaced_arcs = 0, replaced_buckets = 0;
  ReebGraph graph;     // whose arcs come instead,
  ArcBuckets buckets;  // with these
};

// A place in a patch, while nodes and arcs go by in their order.
class PatchReader {
 public:
  explicit PatchReader(GraphPatch patch);
  PatchReader(const PatchReader&) = delete;
  PatchReader& operator=(const PatchReader&) = delete;

  const GraphPatch& patch() const { return patch_; }
  void rewind_nodes() { gone_ = 0; }
  void rewind_arcs() { redone_ = arc_ = 0; }

  // REQUIRES, since the last rewind: ascending; for arcs, by lo.
  bool drops(const SweepKey& node);
  bool drops(const ArcKeys& arc);

  // Whether an arc of the patch comes before this stored one, or, if null, is left. What was joined
  // has the place of its lower part, so it comes before a stored arc between the same nodes.
  bool comes_before(const ArcKeys* stored) const;
  // Moves that arc to the end of `piece`, with its buckets if they are wanted.
  void take(ArcPiece& piece);

 private:
  ArcKeys keys(std::size_t arc) const {
    return {patch_.graph.nodes[patch_.graph.lo[arc].value()], patch_.graph.nodes[patch_.graph.hi[arc].value()]};
  }

  GraphPatch patch_;
  NodeTable table_;  // of redone nodes
  std::size_t gone_ = 0, redone_ = 0, arc_ = 0;
};

}  // namespace reeb::ooc
