#include "libreeb/sweep/fragment.h"

namespace reeb {

void Fragment::pass_settled_to(GraphSink& sink) const {
  if (!settled_nodes.empty()) sink.add_nodes(settled_nodes);
  if (!settled_arcs.empty()) sink.add_arcs({settled_arcs, settled_lists.view(), options.bucket_exponent.value_or(0)});
}

std::size_t Fragment::memory_bytes() const {
  return nodes.capacity() * sizeof(Node) + positions.capacity() * sizeof(Point) + arcs.capacity() * sizeof(Arc) +
         (edges.capacity() + closed_edges.capacity()) * sizeof(SharedEdge) +
         4 * (path_begin.capacity() + path_arcs.capacity()) + steps.capacity() * sizeof(Step) +
         passed.capacity() * sizeof(Passed) + 4 * bucket_begin.capacity() + buckets.capacity() * sizeof(BucketSum) +
         settled_lists.memory_bytes() + settled_nodes.capacity() * sizeof(SettledNode) +
         settled_arcs.capacity() * sizeof(ArcKeys) +
         (on_open_arcs.capacity() + on_settled_arcs.capacity()) * sizeof(Regular);
}

}  // namespace reeb
