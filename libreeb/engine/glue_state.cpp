// Saving and restoring the glue between two fragments. The two maps are told from the arrays.
#include "libreeb/engine/glue.h"

namespace reeb {

void Glue::save(StateWriter& out) const {
  graph_.save(out);
  out.put(removed_in_fragments_);
  first_link_.save(out);
  edges_.save(out);
  links_.save(out);
  out.put(first_free_edge_);
}

void Glue::restore(StateReader& in) {
  graph_.restore(in);
  in.get(removed_in_fragments_);
  first_link_.restore(in);
  edges_.restore(in);
  links_.restore(in);
  in.get(first_free_edge_);

  node_of_.clear();
  for (Index n = 0; n < first_link_.size(); ++n)
    if (graph_.is_incomplete(n)) node_of_.find_or_insert(graph_.key(n).vertex.value(), n);
  edge_of_.clear();
  std::vector<bool> is_free(edges_.size());
  for (Index e = first_free_edge_; e != kNone; e = edges_[e].top) is_free[e] = true;
  for (Index e = 0; e < edges_.size(); ++e)
    if (!is_free[e]) edge_of_.find_or_insert(edge_key(edges_[e].lo, edges_[e].hi), e);
}

}  // namespace reeb
