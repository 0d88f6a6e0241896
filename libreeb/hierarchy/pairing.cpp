#include "libreeb/hierarchy/pairing.h"

#include "libreeb/hierarchy/pair_sweeps.h"

namespace reeb {

std::vector<PersistencePair> persistence_pairs(const ReebGraph& graph, const Poll& poll) {
  return sorted_pairs(graph, swept_pairs(graph, poll, {}));
}

}  // namespace reeb
