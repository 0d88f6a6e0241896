// Saving and restoring the live graph between two fragments.
#include "libreeb/engine/live_graph.h"

namespace reeb {

void LiveGraph::save(StateWriter& out) const {
  out.put(track_positions_);
  out.put(noise_below_);
  out.put(noticed_below_);
  out.put(removed_pairs_);
  out.put(embeds_);
  buckets_.save(out);
  arc_buckets_.save(out);
  nodes_.save(out);
  positions_.save(out);
  arcs_.save(out);
  references_.save(out);
  nodes_.save_first_free(out);
  arcs_.save_first_free(out);
  references_.save_first_free(out);
  nodes_.save_free_count(out);
  arcs_.save_free_count(out);
  references_.save_free_count(out);
}

void LiveGraph::restore(StateReader& in) {
  if (in.get<bool>() != track_positions_) throw DamagedState();
  in.get(noise_below_);
  in.get(noticed_below_);
  in.get(removed_pairs_);
  in.get(embeds_);
  buckets_.restore(in);
  arc_buckets_.restore(in);
  nodes_.restore(in);
  positions_.restore(in);
  arcs_.restore(in);
  references_.restore(in);
  nodes_.restore_first_free(in);
  arcs_.restore_first_free(in);
  references_.restore_first_free(in);
  nodes_.restore_free_count(in);
  arcs_.restore_free_count(in);
  references_.restore_free_count(in);
}

}  // namespace reeb
