#include "libreeb/engine/live_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace reeb {

void LiveGraph::set_options(const SweepOptions& options) {
  set_noise(options.noise_below);
  if (!options.bucket_exponent) return;
  embeds_ = true;
  grow_arc_buckets();
  buckets_.raise_exponent(*options.bucket_exponent, arc_buckets_);
}

void LiveGraph::grow_arc_buckets() {
  while (arc_buckets_.size() < arcs_.size()) {
    arc_buckets_.grow_by(1);
    arc_buckets_[arc_buckets_.size() - 1] = {};
  }
}

// ---- nodes and arcs

LiveGraph::Index LiveGraph::add_node(const SweepKey& key, const Point& position, State state) {
  const Index n = nodes_.take();
  nodes_[n] = {key, {kNone, kNone}, {0, 0}, 0, state, state != State::kSettled, false, true, false};
  if (track_positions_) {
    if (positions_.size() < nodes_.size()) positions_.grow_by(1);
    positions_[n] = position;
  }
  // tidy() examines a complete node when the arcs and paths of its fragment are in place.
  if (state != State::kIncomplete) queue(n);
  return n;
}

void LiveGraph::free_node(Index n) {
  nodes_[n].used = false;
  nodes_.free(n);
}

LiveGraph::Index LiveGraph::add_arc(Index lo, Index hi) {
  const Index a = arcs_.take();
  if (embeds_) grow_arc_buckets();
  arcs_[a].first_reference = kNone;
  arcs_[a].references = 0;
  attach(a, kDown, lo);
  attach(a, kUp, hi);
  if (log_ != nullptr) log_->add(a);
  return a;
}

void LiveGraph::release(Index a) {
  notice_noise(a);
  if (can_leave(a)) write_out(a);
}

void LiveGraph::add_buckets(Index arc, std::span<const BucketSum> buckets) {
  for (const BucketSum& bucket : buckets) buckets_.append(arc_buckets_[arc], bucket);
}

// Buckets are moved after their arcs were relinked. Prefetched before that, they arrive in the cache meanwhile.
void LiveGraph::prefetch_buckets(Index a, Index b) const {
  if (!embeds_) return;
  buckets_.prefetch(arc_buckets_[a]);
  buckets_.prefetch(arc_buckets_[b]);
}

void LiveGraph::free_arc(Index a) {
  arcs_[a].end[kDown] = kNone;
  arcs_.free(a);
}

void LiveGraph::attach(Index a, Direction side, Index n) {
  Arc& arc = arcs_[a];
  Node& node = nodes_[n];
  arc.end[side] = n;
  Links& links = arc.links[side];
  links = {std::exchange(node.first_at[side], a), kNone};
  if (links.next != kNone) arcs_[links.next].links[side].prev = a;
  ++node.degree_at[side];
  if (arc.references != 0) ++node.referenced_arcs;
}

void LiveGraph::detach(Index a, Direction side) {
  const Arc& arc = arcs_[a];
  Node& node = nodes_[arc.end[side]];
  const Links& links = arc.links[side];
  (links.prev == kNone ? node.first_at[side] : arcs_[links.prev].links[side].next) = links.next;
  if (links.next != kNone) arcs_[links.next].links[side].prev = links.prev;
  --node.degree_at[side];
  if (arc.references != 0) --node.referenced_arcs;
}

// ---- references

void LiveGraph::link(Index r, Index a) {
  Arc& arc = arcs_[a];
  Reference& reference = references_[r];
  reference.arc = a;
  reference.prev = kNone;
  reference.next = std::exchange(arc.first_reference, r);
  if (reference.next != kNone) references_[reference.next].prev = r;
  ++arc.references;
}

void LiveGraph::unlink(Index r) {
  const Reference& reference = references_[r];
  Arc& arc = arcs_[reference.arc];
  (reference.prev == kNone ? arc.first_reference : references_[reference.prev].next) = reference.next;
  if (reference.next != kNone) references_[reference.next].prev = reference.prev;
  --arc.references;
}

void LiveGraph::gained_reference(Index a) {
  ++nodes_[arcs_[a].lo()].referenced_arcs;
  ++nodes_[arcs_[a].hi()].referenced_arcs;
}

void LiveGraph::lost_references(Index a) {
  const Index lo = arcs_[a].lo(), hi = arcs_[a].hi();
  for (const Index n : {lo, hi}) {
    --nodes_[n].referenced_arcs;
    queue(n);
  }
  if (can_leave(a)) write_out(a);
}

LiveGraph::Index LiveGraph::add_reference(Index arc, Index below) {
  const Index r = references_.take();
  link(r, arc);
  references_[r].down = below;
  if (arcs_[arc].references == 1) gained_reference(arc);
  return r;
}

void LiveGraph::drop_path(Index top) {
  while (top != kNone) {
    const Index a = references_[top].arc;
    unlink(top);
    if (arcs_[a].references == 0) lost_references(a);
    const Index below = references_[top].down;
    references_.free(top);
    top = below;
  }
}

// ---- zipping

void LiveGraph::zip(Index a, Index b) {
  ++zips_;
  for (; b != kNone; ++zip_steps_) {
    const Index arc_a = references_[a].arc, arc_b = references_[b].arc;
    if (arc_a != arc_b) {
      const Index lo_a = arcs_[arc_a].lo(), lo_b = arcs_[arc_b].lo();
      if (lo_a == lo_b) {
        if (arcs_[arc_a].references >= arcs_[arc_b].references)
          merge_parallel(arc_a, arc_b);
        else
          merge_parallel(arc_b, arc_a);
      } else if (nodes_[lo_a].key < nodes_[lo_b].key) {
        cut(arc_a, arc_b);
      } else {
        cut(arc_b, arc_a);
      }
    }
    // Both references are on the same arc now: drop one of them.
    unlink(b);
    const Index below = references_[b].down;
    references_.free(b);
    b = below;
    a = references_[a].down;
  }
}

void LiveGraph::merge_parallel(Index keep, Index gone) {
  prefetch_buckets(keep, gone);
  Index last = kNone;
  for (Index r = arcs_[gone].first_reference; r != kNone; r = references_[r].next) {
    references_[r].arc = keep;
    last = r;
  }
  Arc& kept = arcs_[keep];
  references_[last].next = kept.first_reference;
  if (kept.first_reference != kNone) references_[kept.first_reference].prev = last;
  kept.first_reference = arcs_[gone].first_reference;
  kept.references += arcs_[gone].references;
  queue(arcs_[gone].lo());
  queue(arcs_[gone].hi());
  if (log_ != nullptr) log_->merge(gone, keep);
  detach(gone);
  notice_noise(keep);
  free_arc(gone);
  if (embeds_) buckets_.merge(arc_buckets_[keep], arc_buckets_[gone]);
}

// `longer` and `shorter` have the same upper end. The upper part of `longer` is merged into `shorter`; the rest of
// `longer` then ends at the lower node of `shorter`.
void LiveGraph::cut(Index longer, Index shorter) {
  const Index top = arcs_[longer].hi(), bottom = arcs_[shorter].lo();
  prefetch_buckets(longer, shorter);
  queue(top);
  detach(longer, kUp);
  Index r = std::exchange(arcs_[longer].first_reference, kNone);
  arcs_[longer].references = 0;
  while (r != kNone) {
    const Index next = references_[r].next;
    const Index rest = references_.take();
    references_[rest].down = std::exchange(references_[r].down, rest);
    link(rest, longer);
    link(r, shorter);
    r = next;
  }
  attach(longer, kUp, bottom);
  if (log_ != nullptr) log_->cut(longer, shorter, nodes_[bottom].key, kUp);
  notice_noise(longer);
  notice_noise_at(top);
  if (embeds_) {
    const auto value = [&](Index n) { return nodes_[n].key.value; };
    buckets_.move_above(arc_buckets_[longer], value(arcs_[longer].lo()), value(bottom), value(top),
                        arc_buckets_[shorter]);
  }
}

// ---- completing, contracting, settling

void LiveGraph::queue(Index n) {
  Node& node = nodes_[n];
  if (node.queued || node.state == State::kIncomplete) return;
  node.queued = true;
  changed_.push_back(n);
}

void LiveGraph::complete(Index n) {
  nodes_[n].state = State::kComplete;
  queue(n);
}

void LiveGraph::tidy() {
  while (!changed_.empty()) {
    const Index n = changed_.back();
    changed_.pop_back();
    Node& node = nodes_[n];
    node.queued = false;
    if (!node.used) continue;
    if (node.near_noise) remove_noise_at(n);
    if (!node.used) continue;
    if (is_pass_through(node))
      contract(n);
    else if (node.state == State::kComplete && stays_for_good(node))
      settle(n);
    // A settled node is written out after its last arc; without arcs, at once.
    if (node.used && node.state == State::kSettled && node.degree() == 0) {
      settled_.add_node({node.key, track_positions_ ? positions_[n] : Point{}});
      free_node(n);
    }
  }
  flush_if_many();
}

// Whether a complete node that is not a (1, 1) node will never become one. Zips merge referenced arcs with each other
// only, and leave at least one on each side that has any. So a side with two arcs keeps two for good if one of them is
// not referenced, and an empty side stays empty. But noise can be removed only while the arcs of its saddle are here.
// So a node near noise waits until none of its arcs is referenced.
bool LiveGraph::stays_for_good(const Node& node) const {
  if (node.near_noise) return node.referenced_arcs == 0;
  if (node.degree(kUp) == 0 || node.degree(kDown) == 0) return true;
  std::uint32_t lasting = node.degree() - node.referenced_arcs;
  for (const Direction d : {kUp, kDown})
    if (node.degree(d) == 1 && arcs_[node.first(d)].references == 0) --lasting;
  return lasting != 0;
}

bool LiveGraph::can_leave(Index a) const {
  return arcs_[a].references == 0 && nodes_[arcs_[a].lo()].state == State::kSettled &&
         nodes_[arcs_[a].hi()].state == State::kSettled;
}

// The two arcs of a (1, 1) node become one. Every path on the upper arc continues on the lower one, since no path ends
// at a complete vertex.
void LiveGraph::contract(Index n) {
  const Index upper = nodes_[n].first(kUp), lower = nodes_[n].first(kDown);
  prefetch_buckets(lower, upper);
  if (embeds_ && track_positions_) reeb::prefetch(&positions_[n]);
  for (Index r = arcs_[upper].first_reference; r != kNone; r = references_[r].next) {
    const Index skipped = references_[r].down;
    references_[r].down = references_[skipped].down;
    references_.free(skipped);
  }
  if (log_ != nullptr) log_->join(lower, upper, nodes_[n].key, kDown);
  const Index lo = arcs_[lower].lo(), hi = arcs_[upper].hi();
  detach(lower);
  free_arc(lower);
  detach(upper, kDown);
  attach(upper, kDown, lo);
  if (embeds_) {
    auto& below = arc_buckets_[lower];
    buckets_.concatenate(below, nodes_[n].key.value, track_positions_ ? positions_[n] : Point{}, arc_buckets_[upper]);
    std::swap(below, arc_buckets_[upper]);
  }
  free_node(n);
  notice_noise(upper);
  if (is_noise(upper)) {  // if an end is a leaf, its saddle has changed
    for (const Index end : {lo, hi})
      if (is_leaf(nodes_[end])) try_leaf(end);
    if (!nodes_[lo].used || !nodes_[hi].used) return;
  }
  if (can_leave(upper)) write_out(upper);
}

void LiveGraph::settle(Index n) {
  nodes_[n].state = State::kSettled;
  for (const Direction d : {kUp, kDown})
    for (Index a = nodes_[n].first(d); a != kNone;) {
      const Index next = arcs_[a].next(d);
      if (can_leave(a)) write_out(a);
      a = next;
    }
}

void LiveGraph::write_out(Index a) {
  const Index lo = arcs_[a].lo(), hi = arcs_[a].hi();
  settled_.add_arc({nodes_[lo].key, nodes_[hi].key});
  if (log_ != nullptr) log_->settle(a);
  if (embeds_)
    settled_.add_buckets([&](const auto& add) {
      buckets_.drain(arc_buckets_[a], [&](const BucketSum& bucket) { add(bucket.mean()); });
    });
  detach(a);
  free_arc(a);
  for (const Index n : {lo, hi}) {
    nodes_[n].intact = false;
    if (nodes_[n].degree() == 0) queue(n);
  }
  flush_if_many();  // a vertex can have any number of arcs that settle with it
}

void LiveGraph::flush_if_many() {
  constexpr std::size_t kNodesAndArcsPerFlush = 4096;
  if (settled_.size() >= kNodesAndArcsPerFlush) flush();
}

void LiveGraph::flush() { settled_.flush(*sink_, buckets_.exponent()); }

// ---- looking

void LiveGraph::snapshot(std::vector<ArcKeys>& arcs, std::vector<SweepKey>& isolated) const {
  // is_pass_through() is false for a node whose arcs were partly written out: its degree here means nothing.
  const auto stays = [&](const Node& n) { return !is_pass_through(n); };
  for (Index n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    if (!node.used || !stays(node)) continue;
    if (node.degree() == 0 && node.intact) isolated.push_back(node.key);
    for (Index a = node.first(kUp); a != kNone; a = arcs_[a].next(kUp)) {
      Index end = arcs_[a].hi();
      while (!stays(nodes_[end])) end = arcs_[nodes_[end].first(kUp)].hi();
      arcs.push_back({node.key, nodes_[end].key});
    }
  }
}

std::uint64_t LiveGraph::vertex_bound() const {
  std::uint64_t bound = 0;
  for (const Node& node : nodes_.all())
    if (node.used) bound = std::max(bound, node.key.vertex.value() + 1);
  return bound;
}

std::size_t LiveGraph::memory_bytes() const {
  return nodes_.memory_bytes() + positions_.memory_bytes() + arcs_.memory_bytes() + references_.memory_bytes() +
         changed_.capacity() * sizeof(Index) + settled_.memory_bytes() + buckets_.memory_bytes() +
         arc_buckets_.memory_bytes();
}

std::size_t LiveGraph::growth_bytes(std::size_t nodes, std::size_t arcs, std::size_t references,
                                    std::size_t buckets) const {
  const auto beyond_free = [](std::size_t count, const auto& array) {
    return count - std::min(count, array.size() - array.used());
  };
  const std::size_t list = embeds_ ? sizeof(BucketLists::List) : 0, place = track_positions_ ? sizeof(Point) : 0;
  return beyond_free(nodes, nodes_) * (sizeof(Node) + place) + beyond_free(arcs, arcs_) * (sizeof(Arc) + list) +
         beyond_free(references, references_) * sizeof(Reference) + buckets_.growth_bytes(buckets);
}

void LiveGraph::validate() const {
  const auto fail = [](const std::string& what, std::size_t id) {
    throw std::logic_error("LiveGraph: " + what + " " + std::to_string(id));
  };
  std::vector<std::uint32_t> up(nodes_.size()), down(nodes_.size()), referenced(nodes_.size());
  std::size_t on_arcs = 0;
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
    if (can_leave(a)) fail("not handed over: arc", a);
    const Node &lo = nodes_[arc.lo()], &hi = nodes_[arc.hi()];
    if (is_noise(a) && (is_leaf(lo) || is_leaf(hi)) && !(lo.near_noise && hi.near_noise))
      fail("no node notices leaf", a);
    on_arcs += references;
    if (references != 0) {
      ++referenced[arc.lo()];
      ++referenced[arc.hi()];
    }
  }
  if (on_arcs != reference_count()) fail("references astray:", reference_count() - on_arcs);
  for (Index n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    if (!node.used) continue;
    if (node.degree(kUp) != up[n] || node.degree(kDown) != down[n]) fail("wrong degree of node", n);
    if (node.referenced_arcs != referenced[n]) fail("wrong count of referenced arcs at node", n);
    if (node.state == State::kComplete && (is_pass_through(node) || stays_for_good(node))) fail("not tidied: node", n);
  }
}

// ---- saving and restoring, between two fragments

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
  references_.restore(in);
  nodes_.restore_first_free(in);
  arcs_.restore_first_free(in);
  references_.restore_first_free(in);
  nodes_.restore_free_count(in);
  arcs_.restore_free_count(in);
  references_.restore_free_count(in);
  check_restored();
}

// Nothing that was restored is used before it is known to be in range; then lists, then what they mean.
void LiveGraph::check_restored() {
  const auto require = [](bool sound) {
    if (!sound) throw DamagedState();
  };
  require(positions_.size() == (track_positions_ ? nodes_.size() : 0));
  require(arc_buckets_.size() == (embeds_ ? arcs_.size() : 0));
  const std::vector<bool> free_nodes = nodes_.restored_free(), free_arcs = arcs_.restored_free();
  std::vector<bool> seen = references_.restored_free();
  for (Index n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    require(node.used != free_nodes[n]);
    if (node.used)
      require(std::isfinite(node.key.value) && node.key.vertex.value() + 1 != 0 && node.state <= State::kSettled &&
              !node.queued);
  }
  std::array<std::size_t, 2> arcs_in_lists{};
  for (Index a = 0; a < arcs_.size(); ++a) {
    const Arc& arc = arcs_[a];
    require(arc.is_free() == free_arcs[a]);
    if (arc.is_free()) {
      require(!embeds_ || arc_buckets_[a].empty());
      continue;
    }
    require(arc.lo() < nodes_.size() && nodes_[arc.lo()].used && arc.hi() < nodes_.size() && nodes_[arc.hi()].used);
    require(nodes_[arc.lo()].key < nodes_[arc.hi()].key);
    std::size_t references = 0;
    for (Index r = arc.first_reference, before = kNone; r != kNone; before = r, r = references_[r].next) {
      require(r < references_.size() && !seen[r] && references_[r].arc == a && references_[r].prev == before);
      seen[r] = true;
      ++references;
    }
    require(references == arc.references);
  }
  require(std::find(seen.begin(), seen.end(), false) == seen.end());
  for (Index n = 0; n < nodes_.size(); ++n)
    for (const Direction side : {kDown, kUp}) {
      if (!nodes_[n].used) continue;
      std::size_t degree = 0;
      for (Index a = nodes_[n].first_at[side], before = kNone; a != kNone;
           before = a, a = arcs_[a].links[side].next, ++degree)
        require(a < arcs_.size() && !arcs_[a].is_free() && arcs_[a].end[side] == n &&
                arcs_[a].links[side].prev == before && degree < arcs_.size());
      require(degree == nodes_[n].degree_at[side]);
      arcs_in_lists[side] += degree;
    }
  require(arcs_in_lists[kDown] == arcs_.used() && arcs_in_lists[kUp] == arcs_.used());
  // Each reference is below at most one other, on an arc that begins where the arc of the other ends.
  path_tops_.assign(references_.size(), true);
  const std::vector<bool> free_references = references_.restored_free();
  for (Index r = 0; r < references_.size(); ++r) {
    if (free_references[r]) path_tops_[r] = false;
    const Index below = free_references[r] ? kNone : references_[r].down;
    if (below == kNone) continue;
    require(below < references_.size() && !free_references[below] && path_tops_[below]);
    require(arcs_[references_[below].arc].hi() == arcs_[references_[r].arc].lo());
    path_tops_[below] = false;
  }
  buckets_.check_restored(arc_buckets_.all());
  try {
    validate();
  } catch (const std::logic_error&) {
    throw DamagedState();
  }
}

void LiveGraph::check_restored_path(Index top, Index lo, Index hi) {
  if (top >= path_tops_.size() || !path_tops_[top] || arcs_[references_[top].arc].hi() != hi) throw DamagedState();
  path_tops_[top] = false;
  while (references_[top].down != kNone) top = references_[top].down;
  if (arcs_[references_[top].arc].lo() != lo) throw DamagedState();
}

void LiveGraph::check_restored_paths_end() {
  if (std::find(path_tops_.begin(), path_tops_.end(), true) != path_tops_.end()) throw DamagedState();
  std::vector<bool>().swap(path_tops_);
}

}  // namespace reeb
