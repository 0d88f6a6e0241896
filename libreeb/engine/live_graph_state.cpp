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
  for (const Index first : {first_free_node_, first_free_arc_, first_free_reference_}) out.put(first);
  for (const std::size_t count : {free_nodes_, free_arcs_, free_references_}) out.put(std::uint64_t{count});
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
  for (Index* first : {&first_free_node_, &first_free_arc_, &first_free_reference_}) in.get(*first);
  for (std::size_t* count : {&free_nodes_, &free_arcs_, &free_references_})
    *count = static_cast<std::size_t>(in.get<std::uint64_t>());
}

}  // namespace reeb
