// The whole state of the live graph: saved and restored between two fragments, and checked.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "libreeb/engine/live_graph.h"

namespace reeb {

void LiveGraph::save(StateWriter& out) const {
  out.put(track_positions_);
  noise_.save(out);
  out.put(removed_pairs_);
  out.put(embeds_);
  buckets_.save(out);
  arc_buckets_.save(out);
  graph_.save(out);
  positions_.save(out);
  beads_.save(out);
}

LiveGraph::PathTops LiveGraph::restore(StateReader& in) {
  if (in.get_bool() != track_positions_) throw DamagedState();
  noise_.restore(in);
  in.get(removed_pairs_);
  embeds_ = in.get_bool();
  buckets_.restore(in);
  arc_buckets_.restore(in);
  graph_.restore(in);
  positions_.restore(in);
  beads_.restore(in);
  return check_restored();
}

// Nothing that was restored is used before it is known to be in range; then lists, then what they mean.
LiveGraph::PathTops LiveGraph::check_restored() {
  require_state(positions_.size() == (track_positions_ ? graph_.nodes.size() : 0));
  require_state(arc_buckets_.size() == (embeds_ ? graph_.arcs.size() : 0));
  check_restored_nodes();
  check_restored_arcs();
  graph_.check_restored_lists();
  PathTops tops = graph_.check_restored_paths();
  try {
    validate();
  } catch (const std::logic_error&) {
    throw DamagedState();
  }
  return tops;
}

void LiveGraph::check_restored_nodes() {
  const std::vector<bool> free = graph_.nodes.restored_free();
  for (Index n = 0; n < graph_.nodes.size(); ++n) {
    const Node& node = graph_.nodes[n];
    require_state(node.used != free[n]);
    if (node.used)
      require_state(std::isfinite(node.key.value) && node.key.vertex.value() + 1 != 0 &&
                    node.state <= State::kSettled && !node.queued);
  }
}

// Their ends, with what is on them: beads, buckets, references.
void LiveGraph::check_restored_arcs() {
  const std::vector<bool> free = graph_.arcs.restored_free();
  std::vector<bool> seen = graph_.references.restored_free();
  BeadChains::RestoredCheck beads(beads_);
  std::vector<BucketLists::List> bucket_lists(arc_buckets_.all().begin(), arc_buckets_.all().end());
  for (Index a = 0; a < graph_.arcs.size(); ++a) {
    const Arc& arc = graph_.arcs[a];
    require_state(arc.is_free() == free[a]);
    if (arc.is_free()) {
      require_state(!embeds_ || arc_buckets_[a].empty());
      continue;
    }
    require_state(arc.lo() < graph_.nodes.size() && graph_.nodes[arc.lo()].used);
    require_state(arc.hi() < graph_.nodes.size() && graph_.nodes[arc.hi()].used);
    require_state(graph_.nodes[arc.lo()].key < graph_.nodes[arc.hi()].key);
    beads.check(arc.beads, graph_.nodes[arc.lo()].key, graph_.nodes[arc.hi()].key);
    beads_.visit(arc.beads, [&](Index bead) { bucket_lists.push_back(beads_.buckets(bead)); });
    std::size_t references = 0;
    for (Index r = arc.first_reference, before = kNone; r != kNone; before = r, r = graph_.references[r].next) {
      require_state(r < graph_.references.size() && !seen[r] && graph_.references[r].arc == a &&
                    graph_.references[r].prev == before);
      seen[r] = true;
      ++references;
    }
    require_state(references == arc.references);
  }
  beads.end();
  require_state(std::find(seen.begin(), seen.end(), false) == seen.end());
  buckets_.check_restored(bucket_lists);
}

void LiveGraph::validate() const {
  const auto fail = [](const std::string& what, std::size_t id) {
    throw std::logic_error("LiveGraph: " + what + " " + std::to_string(id));
  };
  std::vector<std::uint32_t> up(graph_.nodes.size()), down(graph_.nodes.size()), referenced(graph_.nodes.size());
  std::size_t on_arcs = 0, on_chains = 0;
  for (Index a = 0; a < graph_.arcs.size(); ++a) {
    const Arc& arc = graph_.arcs[a];
    if (arc.is_free()) continue;
    if (!graph_.nodes[arc.lo()].used || !graph_.nodes[arc.hi()].used) fail("a free node ends arc", a);
    if (!(graph_.nodes[arc.lo()].key < graph_.nodes[arc.hi()].key)) fail("not upward: arc", a);
    ++up[arc.lo()];
    ++down[arc.hi()];
    std::uint32_t references = 0;
    for (Index r = arc.first_reference; r != kNone; r = graph_.references[r].next, ++references) {
      if (graph_.references[r].arc != a) fail("on the wrong arc: reference", r);
      const Index below = graph_.references[r].down;
      if (below != kNone && graph_.arcs[graph_.references[below].arc].hi() != arc.lo())
        fail("path broken below reference", r);
    }
    if (references != arc.references) fail("wrong number of references on arc", a);
    if (can_leave(a) || (references == 0 && !arc.beads.empty())) fail("not handed over: arc", a);
    const Node &lo = graph_.nodes[arc.lo()], &hi = graph_.nodes[arc.hi()];
    const SweepKey* above = &hi.key;
    beads_.visit(arc.beads, [&](Index bead) {
      if (!(beads_.key(bead) < *above && lo.key < beads_.key(bead))) fail("beads out of order on arc", a);
      above = &beads_.key(bead);
      ++on_chains;
    });
    if (noise_.is_noise(graph_, a) && (is_leaf(lo) || is_leaf(hi)) && lo.intact && hi.intact &&
        !(lo.near_noise && hi.near_noise))
      fail("no node notices leaf", a);
    on_arcs += references;
    if (references != 0) {
      ++referenced[arc.lo()];
      ++referenced[arc.hi()];
    }
  }
  if (on_chains != beads_.used()) fail("beads on no arc:", beads_.used() - on_chains);
  if (on_arcs != reference_count()) fail("references on no arc:", reference_count() - on_arcs);
  for (Index n = 0; n < graph_.nodes.size(); ++n) {
    const Node& node = graph_.nodes[n];
    if (!node.used) continue;
    if (node.degree(kUp) != up[n] || node.degree(kDown) != down[n]) fail("wrong degree of node", n);
    if (node.referenced_arcs != referenced[n]) fail("wrong count of referenced arcs at node", n);
    const bool is_tidy = node.state != State::kComplete || !(is_pass_through(node) || stays_for_good(node));
    if (!is_tidy || is_bead(node)) fail("not tidied: node", n);
  }
}

}  // namespace reeb
