#include "libreeb/engine/live_graph.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace reeb {

void LiveGraph::set_options(const SweepOptions& options) {
  set_noise(options.noise_below);
  if (!options.bucket_exponent) return;
  embeds_ = true;
  grow_arc_buckets();
  buckets_.raise_exponent(*options.bucket_exponent, [this](const auto& visit) {
    for (Index a = 0; a < arcs_.size(); ++a) {
      visit(arc_buckets_[a]);
      if (!arcs_[a].is_free()) beads_.visit(arcs_[a].beads, [&](Index bead) { visit(beads_.buckets(bead)); });
    }
  });
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
  arcs_[a].beads = {};
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
  if (can_leave(a)) return write_out(a);
  if (!arcs_[a].beads.empty()) unreferenced_.push_back(a);
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
  while (b != kNone) {
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
  zip_beads(keep, gone, arcs_[keep].hi(), arcs_[keep].lo());
  notice_noise(keep);
  free_arc(gone);
}

// Both arcs start at `top`, and `into` ends at `bottom`, where `from` ends or passes. Moves the beads and the buckets
// of `from` above `bottom` to `into`. So the merged beads divide the buckets of both.
void LiveGraph::zip_beads(Index into, Index from, Index top, Index bottom) {
  const SweepKey& end = nodes_[bottom].key;
  const BeadChains::Chain kept = arcs_[into].beads, moved = arcs_[from].beads;
  Index next_kept = beads_.highest(kept), next_moved = beads_.highest(moved);
  const auto moves = [&] { return next_moved != kNone && end < beads_.key(next_moved); };
  if (!embeds_ && !moves()) return;

  // From `reached` down to the next bead of each.
  BucketLists::List kept_buckets, moved_buckets;
  if (embeds_) {
    kept_buckets = arc_buckets_[into];
    moved_buckets = arc_buckets_[from];
  }
  double reached = nodes_[top].key.value;
  const bool all_move = !moved.empty() && end < beads_.key(moved.lowest);
  BeadChains::Chain merged;
  const auto store = [&](BucketLists::List buckets) {
    (merged.empty() ? arc_buckets_[into] : beads_.buckets(merged.lowest)) = buckets;
  };
  const auto value_at = [&](Index bead, Index last) {
    return bead != kNone ? beads_.key(bead).value : nodes_[last].key.value;
  };
  while (moves() || (next_kept != kNone && !moved_buckets.empty())) {
    // Where `into` has nothing more, the rest of the chain comes as it is.
    if (all_move && next_kept == kNone && kept_buckets.empty()) {
      if (embeds_) store(moved_buckets);
      merged = beads_.joined(merged, beads_.from(moved, next_moved));
      next_moved = kNone;
      if (embeds_) moved_buckets = beads_.buckets(merged.lowest);
      reached = beads_.key(merged.lowest).value;
      break;
    }
    ++bead_steps_;
    const bool of_kept = next_kept != kNone && !(moves() && beads_.key(next_kept) < beads_.key(next_moved));
    const Index bead = of_kept ? next_kept : next_moved;
    if (embeds_) {
      BucketLists::List& ending = of_kept ? kept_buckets : moved_buckets;
      BucketLists::List& passing = of_kept ? moved_buckets : kept_buckets;
      const double low = of_kept ? value_at(next_moved, arcs_[from].lo()) : value_at(next_kept, bottom);
      const double value = beads_.key(bead).value;
      buckets_.move_above(passing, low, value, reached, ending);
      store(ending);
      ending = beads_.buckets(bead);
      reached = value;
    }
    (of_kept ? next_kept : next_moved) = beads_.below(of_kept ? kept : moved, bead);
    beads_.append(merged, bead);
  }
  if (embeds_) {
    if (next_moved == kNone && arcs_[from].lo() == bottom)
      buckets_.merge(kept_buckets, moved_buckets);
    else if (!moved_buckets.empty())
      buckets_.move_above(moved_buckets, value_at(next_moved, arcs_[from].lo()), end.value, reached, kept_buckets);
    store(kept_buckets);
    arc_buckets_[from] = moved_buckets;
  }
  arcs_[into].beads = beads_.joined(merged, beads_.from(kept, next_kept));
  arcs_[from].beads = beads_.from(moved, next_moved);
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
  zip_beads(shorter, longer, top, bottom);
  notice_noise(longer);
  notice_noise_at(top);
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
  while (!changed_.empty() || !unreferenced_.empty()) {
    if (changed_.empty()) {
      const Index a = unreferenced_.back();
      unreferenced_.pop_back();
      if (!arcs_[a].is_free() && arcs_[a].references == 0) release_beads(a);
      continue;
    }
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
      settled_.add_node({node.key, position(n)});
      free_node(n);
      flush_if_many();
    }
    if (node.used && is_bead(node)) make_bead(n);
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

// Paths pass it, so that its arcs cannot leave yet, and nothing can change it.
bool LiveGraph::is_bead(const Node& n) const {
  return n.state == State::kSettled && !n.intact && n.degree(kUp) == 1 && n.degree(kDown) == 1 &&
         n.referenced_arcs == 2 && log_ == nullptr;
}

// From the last bead of the arc, or its upper end, to its lower end.
BucketLists::List& LiveGraph::lowest_buckets(Index a) {
  return arcs_[a].beads.empty() ? arc_buckets_[a] : beads_.buckets(arcs_[a].beads.lowest);
}

// The two arcs of a node become one, which is returned, with these beads between them; the node is freed. Every path on
// the upper arc continues on the lower one, since no path ends at a complete vertex.
LiveGraph::Index LiveGraph::join_arcs(Index n, BeadChains::Chain between) {
  const Index upper = nodes_[n].first(kUp), lower = nodes_[n].first(kDown);
  for (Index r = arcs_[upper].first_reference; r != kNone; r = references_[r].next) {
    const Index skipped = references_[r].down;
    references_[r].down = references_[skipped].down;
    references_.free(skipped);
  }
  arcs_[upper].beads = beads_.joined(arcs_[upper].beads, beads_.joined(between, arcs_[lower].beads));
  const Index lo = arcs_[lower].lo();
  detach(lower);
  free_arc(lower);
  detach(upper, kDown);
  attach(upper, kDown, lo);
  free_node(n);
  return upper;
}

void LiveGraph::make_bead(Index n) {
  BucketLists::List below;
  if (embeds_) below = std::exchange(arc_buckets_[nodes_[n].first(kDown)], {});
  join_arcs(n, beads_.make(nodes_[n].key, position(n), below));
}

// The bead is a node again. The arc keeps the beads above it; the new arc below it, which is returned, has the others.
LiveGraph::Index LiveGraph::make_node(Index a, Index bead, BeadChains::Chain above, BeadChains::Chain below) {
  const Index n = add_node(beads_.key(bead), beads_.position(bead), State::kSettled), lo = arcs_[a].lo();
  nodes_[n].intact = false;
  detach(a, kDown);
  attach(a, kDown, n);
  const Index lower = add_arc(lo, n);
  arcs_[a].beads = above;
  arcs_[lower].beads = below;
  if (embeds_) arc_buckets_[lower] = std::exchange(beads_.buckets(bead), {});
  beads_.free(bead);
  return lower;
}

// No path passes the arc any more. So what is between two of its beads leaves; so does the rest beyond its highest and
// its lowest bead, unless the end there is not settled yet.
void LiveGraph::release_beads(Index a) {
  if (BeadChains::Chain beads = arcs_[a].beads; !beads.empty() && nodes_[arcs_[a].hi()].state != State::kSettled) {
    const Index highest = beads_.highest(beads);
    a = make_node(a, highest, {}, beads_.from(beads, beads_.below(beads, highest)));
  }
  if (BeadChains::Chain beads = arcs_[a].beads; !beads.empty() && nodes_[arcs_[a].lo()].state != State::kSettled)
    make_node(a, beads.lowest, beads_.without_lowest(beads), {});
  if (can_leave(a)) write_out(a);
}

void LiveGraph::contract(Index n) {
  const Index above = nodes_[n].first(kUp), lower = nodes_[n].first(kDown);
  prefetch_buckets(lower, above);
  if (embeds_ && track_positions_) reeb::prefetch(&positions_[n]);
  if (log_ != nullptr) log_->join(lower, above, nodes_[n].key, kDown);
  BucketLists::List* const above_buckets = embeds_ ? &lowest_buckets(above) : nullptr;
  const double value = nodes_[n].key.value;
  const Index upper = join_arcs(n, {});
  const Index lo = arcs_[upper].lo(), hi = arcs_[upper].hi();
  if (embeds_) {
    auto& below = arc_buckets_[lower];
    buckets_.concatenate(below, value, position(n), *above_buckets);
    std::swap(below, *above_buckets);
  }
  notice_noise(upper);
  if (is_noise(upper)) {  // if an end is a leaf, its saddle has changed
    for (const Index end : {lo, hi})
      if (is_leaf(nodes_[end])) try_leaf(end);
    if (!nodes_[lo].used || !nodes_[hi].used) return;
  }
  if (can_leave(upper)) return write_out(upper);
  if (arcs_[upper].references == 0 && !arcs_[upper].beads.empty()) unreferenced_.push_back(upper);
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
  if (log_ != nullptr) log_->settle(a);
  SweepKey above = nodes_[hi].key;
  BucketLists::List buckets;  // from there down
  if (embeds_) buckets = std::exchange(arc_buckets_[a], {});
  const auto add_arc_from = [&](const SweepKey& below) {
    settled_.add_arc({below, std::exchange(above, below)});
    if (!embeds_) return;
    settled_.add_buckets(
        [&](const auto& add) { buckets_.drain(buckets, [&](const BucketSum& bucket) { add(bucket.mean()); }); });
  };
  beads_.visit(std::exchange(arcs_[a].beads, {}), [&](Index bead) {
    add_arc_from(beads_.key(bead));
    settled_.add_node({beads_.key(bead), beads_.position(bead)});
    buckets = std::exchange(beads_.buckets(bead), {});
    beads_.free(bead);
    flush_if_many();
  });
  add_arc_from(nodes_[lo].key);
  detach(a);
  free_arc(a);
  for (const Index n : {lo, hi}) {
    nodes_[n].intact = false;
    if (nodes_[n].degree() == 0 || is_bead(nodes_[n])) queue(n);
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
    for (Index a = node.first(kDown); a != kNone; a = arcs_[a].next(kDown)) {
      SweepKey above = node.key;
      const auto add_arc_from = [&](const SweepKey& below) { arcs.push_back({below, std::exchange(above, below)}); };
      Index part = a;
      while (true) {
        beads_.visit(arcs_[part].beads, [&](Index bead) { add_arc_from(beads_.key(bead)); });
        const Node& end = nodes_[arcs_[part].lo()];
        if (stays(end)) break;
        part = end.first(kDown);
      }
      add_arc_from(nodes_[arcs_[part].lo()].key);
    }
  }
}

std::uint64_t LiveGraph::vertex_bound() const {
  std::uint64_t bound = 0;
  const auto include = [&](const SweepKey& key) { bound = std::max(bound, key.vertex.value() + 1); };
  for (const Node& node : nodes_.all())
    if (node.used) include(node.key);
  for (const Arc& arc : arcs_.all())
    if (!arc.is_free()) beads_.visit(arc.beads, [&](Index bead) { include(beads_.key(bead)); });
  return bound;
}

std::size_t LiveGraph::path_arc_count() const {
  std::size_t count = 0;
  for (const Arc& arc : arcs_.all()) {
    if (arc.is_free()) continue;
    count += arc.references;
    beads_.visit(arc.beads, [&](Index) { count += arc.references; });
  }
  return count;
}

std::size_t LiveGraph::memory_bytes() const {
  return nodes_.memory_bytes() + positions_.memory_bytes() + arcs_.memory_bytes() + beads_.memory_bytes() +
         references_.memory_bytes() + (changed_.capacity() + unreferenced_.capacity()) * sizeof(Index) +
         settled_.memory_bytes() + buckets_.memory_bytes() + arc_buckets_.memory_bytes() +
         path_buckets_.capacity() * sizeof(PathBuckets);
}

std::size_t LiveGraph::growth_bytes(std::size_t nodes, std::size_t arcs, std::size_t references,
                                    std::size_t buckets) const {
  const auto beyond_free = [](std::size_t count, const auto& array) {
    return count - std::min(count, array.size() - array.used());
  };
  const std::size_t list = embeds_ ? sizeof(BucketLists::List) : 0, place = track_positions_ ? sizeof(Point) : 0;
  return beyond_free(nodes, nodes_) * (sizeof(Node) + place) + beyond_free(arcs, arcs_) * (sizeof(Arc) + list) +
         beads_.growth_bytes(nodes) + beyond_free(references, references_) * sizeof(Reference) +
         buckets_.growth_bytes(buckets);
}

}  // namespace reeb
