// The whole state of the live graph: saved and restored between two fragments, and checked.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

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
  beads_.save(out);
  references_.save(out);
  nodes_.save_first_free(out);
  arcs_.save_first_free(out);
  references_.save_first_free(out);
  nodes_.save_free_count(out);
  arcs_.save_free_count(out);
  references_.save_free_count(out);
}

LiveGraph::PathTops LiveGraph::restore(StateReader& in) {
  if (in.get_bool() != track_positions_) throw DamagedState();
  in.get(noise_below_);
  in.get(noticed_below_);
  in.get(removed_pairs_);
  embeds_ = in.get_bool();
  buckets_.restore(in);
  arc_buckets_.restore(in);
  nodes_.restore(in);
  positions_.restore(in);
  arcs_.restore(in);
  beads_.restore(in);
  references_.restore(in);
  nodes_.restore_first_free(in);
  arcs_.restore_first_free(in);
  references_.restore_first_free(in);
  nodes_.restore_free_count(in);
  arcs_.restore_free_count(in);
  references_.restore_free_count(in);
  return check_restored();
}

namespace {

void require_state(bool sound) {
  if (!sound) throw DamagedState();
}

}  // namespace

// Nothing that was restored is used before it is known to be in range; then lists, then what they mean.
LiveGraph::PathTops LiveGraph::check_restored() {
  require_state(positions_.size() == (track_positions_ ? nodes_.size() : 0));
  require_state(arc_buckets_.size() == (embeds_ ? arcs_.size() : 0));
  check_restored_nodes();
  check_restored_arcs();
  check_restored_lists();
  PathTops tops = check_restored_paths();
  try {
    validate();
  } catch (const std::logic_error&) {
    throw DamagedState();
  }
  return tops;
}

void LiveGraph::check_restored_nodes() {
  const std::vector<bool> free = nodes_.restored_free();
  for (Index n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    require_state(node.used != free[n]);
    if (node.used)
      require_state(std::isfinite(node.key.value) && node.key.vertex.value() + 1 != 0 &&
                    node.state <= State::kSettled && !node.queued);
  }
}

// Their ends, with what is on them: beads, buckets, references.
void LiveGraph::check_restored_arcs() {
  const std::vector<bool> free = arcs_.restored_free();
  std::vector<bool> seen = references_.restored_free();
  BeadChains::RestoredCheck beads(beads_);
  std::vector<BucketLists::List> bucket_lists(arc_buckets_.all().begin(), arc_buckets_.all().end());
  for (Index a = 0; a < arcs_.size(); ++a) {
    const Arc& arc = arcs_[a];
    require_state(arc.is_free() == free[a]);
    if (arc.is_free()) {
      require_state(!embeds_ || arc_buckets_[a].empty());
      continue;
    }
    require_state(arc.lo() < nodes_.size() && nodes_[arc.lo()].used);
    require_state(arc.hi() < nodes_.size() && nodes_[arc.hi()].used);
    require_state(nodes_[arc.lo()].key < nodes_[arc.hi()].key);
    beads.check(arc.beads, nodes_[arc.lo()].key, nodes_[arc.hi()].key);
    beads_.visit(arc.beads, [&](Index bead) { bucket_lists.push_back(beads_.buckets(bead)); });
    std::size_t references = 0;
    for (Index r = arc.first_reference, before = kNone; r != kNone; before = r, r = references_[r].next) {
      require_state(r < references_.size() && !seen[r] && references_[r].arc == a && references_[r].prev == before);
      seen[r] = true;
      ++references;
    }
    require_state(references == arc.references);
  }
  beads.end();
  require_state(std::find(seen.begin(), seen.end(), false) == seen.end());
  buckets_.check_restored(bucket_lists);
}

// The arcs at each node.
void LiveGraph::check_restored_lists() const {
  std::array<std::size_t, 2> arcs_in_lists{};
  for (Index n = 0; n < nodes_.size(); ++n)
    for (const Direction side : {kDown, kUp}) {
      if (!nodes_[n].used) continue;
      std::size_t degree = 0;
      for (Index a = nodes_[n].first_at[side], before = kNone; a != kNone;
           before = a, a = arcs_[a].links[side].next, ++degree)
        require_state(a < arcs_.size() && !arcs_[a].is_free() && arcs_[a].end[side] == n &&
                      arcs_[a].links[side].prev == before && degree < arcs_.size());
      require_state(degree == nodes_[n].degree_at[side]);
      arcs_in_lists[side] += degree;
    }
  require_state(arcs_in_lists[kDown] == arcs_.used() && arcs_in_lists[kUp] == arcs_.used());
}

// Each reference is below at most one other, on an arc that begins where the arc of the other ends.
LiveGraph::PathTops LiveGraph::check_restored_paths() {
  PathTops tops(references_.size(), true);
  const std::vector<bool> free = references_.restored_free();
  for (Index r = 0; r < references_.size(); ++r) {
    if (free[r]) tops[r] = false;
    const Index below = free[r] ? kNone : references_[r].down;
    if (below == kNone) continue;
    require_state(below < references_.size() && !free[below] && tops[below]);
    require_state(arcs_[references_[below].arc].hi() == arcs_[references_[r].arc].lo());
    tops[below] = false;
  }
  return tops;
}

bool LiveGraph::has_ends(Index top, Index lo, Index hi) const {
  if (arcs_[references_[top].arc].hi() != hi) return false;
  while (references_[top].down != kNone) top = references_[top].down;
  return arcs_[references_[top].arc].lo() == lo;
}

void LiveGraph::validate() const {
  const auto fail = [](const std::string& what, std::size_t id) {
    throw std::logic_error("LiveGraph: " + what + " " + std::to_string(id));
  };
  std::vector<std::uint32_t> up(nodes_.size()), down(nodes_.size()), referenced(nodes_.size());
  std::size_t on_arcs = 0, on_chains = 0;
  for (Index a = 0; a < arcs_.size(); ++a) {
    const Arc& arc = arcs_[a];
    if (arc.is_free()) continue;
    if (!nodes_[arc.lo()].used || !nodes_[arc.hi()].used) fail("a free node ends arc", a);
    if (!(nodes_[arc.lo()].key < nodes_[arc.hi()].key)) fail("not upward: arc", a);
    ++up[arc.lo()];
    ++down[arc.hi()];
    std::uint32_t references = 0;
    for (Index r = arc.first_reference; r != kNone; r = references_[r].next, ++references) {
      if (references_[r].arc != a) fail("on the wrong arc: reference", r);
      const Index below = references_[r].down;
      if (below != kNone && arcs_[references_[below].arc].hi() != arc.lo()) fail("path broken below reference", r);
    }
    if (references != arc.references) fail("wrong number of references on arc", a);
    if (can_leave(a) || (references == 0 && !arc.beads.empty())) fail("not handed over: arc", a);
    const Node &lo = nodes_[arc.lo()], &hi = nodes_[arc.hi()];
    const SweepKey* above = &hi.key;
    beads_.visit(arc.beads, [&](Index bead) {
      if (!(beads_.key(bead) < *above && lo.key < beads_.key(bead))) fail("beads out of order on arc", a);
      above = &beads_.key(bead);
      ++on_chains;
    });
    if (is_noise(a) && (is_leaf(lo) || is_leaf(hi)) && !(lo.near_noise && hi.near_noise))
      fail("no node notices leaf", a);
    on_arcs += references;
    if (references != 0) {
      ++referenced[arc.lo()];
      ++referenced[arc.hi()];
    }
  }
  if (on_chains != beads_.used()) fail("beads on no arc:", beads_.used() - on_chains);
  if (on_arcs != reference_count()) fail("references on no arc:", reference_count() - on_arcs);
  for (Index n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    if (!node.used) continue;
    if (node.degree(kUp) != up[n] || node.degree(kDown) != down[n]) fail("wrong degree of node", n);
    if (node.referenced_arcs != referenced[n]) fail("wrong count of referenced arcs at node", n);
    const bool is_tidy = node.state != State::kComplete || !(is_pass_through(node) || stays_for_good(node));
    if (!is_tidy || is_bead(node)) fail("not tidied: node", n);
  }
}

}  // namespace reeb
