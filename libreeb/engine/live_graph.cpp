#include "libreeb/engine/live_graph.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace reeb {

void LiveGraph::set_options(const SweepOptions& options) {
  noise_.set_threshold(graph_, options.noise_below);
  if (!options.bucket_exponent) return;
  embeds_ = true;
  grow_arc_buckets();
  buckets_.raise_exponent(*options.bucket_exponent, [this](const auto& visit) {
    for (Index a = 0; a < graph_.arcs.size(); ++a) {
      visit(arc_buckets_[a]);
      if (!graph_.arcs[a].is_free())
        beads_.visit(graph_.arcs[a].beads, [&](Index bead) { visit(beads_.buckets(bead)); });
    }
  });
}

void LiveGraph::grow_arc_buckets() {
  while (arc_buckets_.size() < graph_.arcs.size()) arc_buckets_.append({});
}

// ---- nodes and arcs

LiveGraph::Index LiveGraph::add_node(const SweepKey& key, const Point& position, State state) {
  const Index n = graph_.nodes.take();
  graph_.nodes[n] = {key, {kNone, kNone}, {0, 0}, 0, state, state != State::kSettled, false, true, false, false, false};
  if (track_positions_) {
    if (positions_.size() < graph_.nodes.size()) positions_.grow_by(1);
    positions_[n] = position;
  }
  // tidy() examines a complete node when the arcs and paths of its fragment are in place.
  if (state != State::kIncomplete) queue(n);
  return n;
}

LiveGraph::Index LiveGraph::add_arc(Index lo, Index hi) {
  const Index a = graph_.arcs.take();
  if (embeds_) grow_arc_buckets();
  graph_.arcs[a].first_reference = kNone;
  graph_.arcs[a].references = 0;
  graph_.arcs[a].beads = {};
  graph_.attach(a, kDown, lo);
  graph_.attach(a, kUp, hi);
  if (log_ != nullptr) log_->add(a);
  return a;
}

void LiveGraph::release(Index a) {
  noise_.notice(graph_, a);
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

// ---- references

void LiveGraph::gained_reference(Index a) {
  ++graph_.nodes[graph_.arcs[a].lo()].referenced_arcs;
  ++graph_.nodes[graph_.arcs[a].hi()].referenced_arcs;
}

void LiveGraph::lost_references(Index a) {
  const Index lo = graph_.arcs[a].lo(), hi = graph_.arcs[a].hi();
  for (const Index n : {lo, hi}) {
    --graph_.nodes[n].referenced_arcs;
    queue(n);
  }
  if (can_leave(a)) return write_out(a);
  if (!graph_.arcs[a].beads.empty()) unreferenced_.push_back(a);
}

LiveGraph::Index LiveGraph::add_reference(Index arc, Index below) {
  const Index r = graph_.references.take();
  graph_.link(r, arc);
  graph_.references[r].down = below;
  if (graph_.arcs[arc].references == 1) gained_reference(arc);
  return r;
}

void LiveGraph::drop_path(Index top) {
  while (top != kNone) {
    const Index a = graph_.references[top].arc;
    graph_.unlink(top);
    if (graph_.arcs[a].references == 0) lost_references(a);
    const Index below = graph_.references[top].down;
    graph_.references.free(top);
    top = below;
  }
}

// ---- zipping

void LiveGraph::zip(Index a, Index b) {
  while (b != kNone) {
    const Index arc_a = graph_.references[a].arc, arc_b = graph_.references[b].arc;
    if (arc_a != arc_b) {
      const Index lo_a = graph_.arcs[arc_a].lo(), lo_b = graph_.arcs[arc_b].lo();
      if (lo_a == lo_b) {
        if (graph_.arcs[arc_a].references >= graph_.arcs[arc_b].references)
          merge_parallel(arc_a, arc_b);
        else
          merge_parallel(arc_b, arc_a);
      } else if (graph_.nodes[lo_a].key < graph_.nodes[lo_b].key) {
        cut(arc_a, arc_b);
      } else {
        cut(arc_b, arc_a);
      }
    }
    // Both references are on the same arc now: drop one of them.
    graph_.unlink(b);
    const Index below = graph_.references[b].down;
    graph_.references.free(b);
    b = below;
    a = graph_.references[a].down;
  }
}

void LiveGraph::merge_parallel(Index keep, Index gone) {
  Index last = kNone;
  for (Index r = graph_.arcs[gone].first_reference; r != kNone; r = graph_.references[r].next) {
    graph_.references[r].arc = keep;
    last = r;
  }
  Arc& kept = graph_.arcs[keep];
  graph_.references[last].next = kept.first_reference;
  if (kept.first_reference != kNone) graph_.references[kept.first_reference].prev = last;
  kept.first_reference = graph_.arcs[gone].first_reference;
  kept.references += graph_.arcs[gone].references;
  queue(graph_.arcs[gone].lo());
  queue(graph_.arcs[gone].hi());
  if (log_ != nullptr) log_->merge(gone, keep);
  graph_.detach(gone);
  zip_beads(keep, gone, graph_.arcs[keep].hi(), graph_.arcs[keep].lo());
  noise_.notice(graph_, keep);
  graph_.free_arc(gone);
}

// Both arcs start at `top`, and `into` ends at `bottom`, where `from` ends or passes. Moves the beads and the buckets
// of `from` above `bottom` to `into`. So the merged beads divide the buckets of both.
void LiveGraph::zip_beads(Index into, Index from, Index top, Index bottom) {
  const SweepKey& end = graph_.nodes[bottom].key;
  const BeadChains::Chain kept = graph_.arcs[into].beads, moved = graph_.arcs[from].beads;
  Index next_kept = beads_.highest(kept), next_moved = beads_.highest(moved);
  const auto moves = [&] { return next_moved != kNone && end < beads_.key(next_moved); };
  if (!embeds_ && !moves()) return;

  // From `reached` down to the next bead of each.
  BucketLists::List kept_buckets, moved_buckets;
  if (embeds_) {
    kept_buckets = arc_buckets_[into];
    moved_buckets = arc_buckets_[from];
  }
  double reached = graph_.nodes[top].key.value;
  const bool all_move = !moved.empty() && end < beads_.key(moved.lowest);
  BeadChains::Chain merged;
  const auto store = [&](BucketLists::List buckets) {
    (merged.empty() ? arc_buckets_[into] : beads_.buckets(merged.lowest)) = buckets;
  };
  const auto value_at = [&](Index bead, Index last) {
    return bead != kNone ? beads_.key(bead).value : graph_.nodes[last].key.value;
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
      const double low = of_kept ? value_at(next_moved, graph_.arcs[from].lo()) : value_at(next_kept, bottom);
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
    if (next_moved == kNone && graph_.arcs[from].lo() == bottom)
      buckets_.merge(kept_buckets, moved_buckets);
    else if (!moved_buckets.empty())
      buckets_.move_above(moved_buckets, value_at(next_moved, graph_.arcs[from].lo()), end.value, reached,
                          kept_buckets);
    store(kept_buckets);
    arc_buckets_[from] = moved_buckets;
  }
  graph_.arcs[into].beads = beads_.joined(merged, beads_.from(kept, next_kept));
  graph_.arcs[from].beads = beads_.from(moved, next_moved);
}

// `longer` and `shorter` have the same upper end. The upper part of `longer` is merged into `shorter`; the rest of
// `longer` then ends at the lower node of `shorter`.
void LiveGraph::cut(Index longer, Index shorter) {
  const Index top = graph_.arcs[longer].hi(), bottom = graph_.arcs[shorter].lo();
  queue(top);
  graph_.detach(longer, kUp);
  Index r = std::exchange(graph_.arcs[longer].first_reference, kNone);
  graph_.arcs[longer].references = 0;
  while (r != kNone) {
    const Index next = graph_.references[r].next;
    const Index rest = graph_.references.take();
    graph_.references[rest].down = std::exchange(graph_.references[r].down, rest);
    graph_.link(rest, longer);
    graph_.link(r, shorter);
    r = next;
  }
  graph_.attach(longer, kUp, bottom);
  if (log_ != nullptr) log_->cut(longer, shorter, graph_.nodes[bottom].key, kUp);
  zip_beads(shorter, longer, top, bottom);
  noise_.notice(graph_, longer);
  noise_.notice_at(graph_, top);
}

// ---- completing, contracting, settling

void LiveGraph::queue(Index n) {
  Node& node = graph_.nodes[n];
  if (node.queued || node.state == State::kIncomplete) return;
  node.queued = true;
  changed_.push_back(n);
}

void LiveGraph::complete(Index n) {
  graph_.nodes[n].state = State::kComplete;
  queue(n);
}

void LiveGraph::tidy() {
  while (!changed_.empty() || !unreferenced_.empty()) {
    if (changed_.empty()) {
      const Index a = unreferenced_.back();
      unreferenced_.pop_back();
      if (!graph_.arcs[a].is_free() && graph_.arcs[a].references == 0) release_beads(a);
      continue;
    }
    const Index n = changed_.back();
    changed_.pop_back();
    Node& node = graph_.nodes[n];
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
      graph_.free_node(n);
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
    if (node.degree(d) == 1 && graph_.arcs[node.first(d)].references == 0) --lasting;
  return lasting != 0;
}

bool LiveGraph::can_leave(Index a) const {
  return graph_.arcs[a].references == 0 && graph_.nodes[graph_.arcs[a].lo()].state == State::kSettled &&
         graph_.nodes[graph_.arcs[a].hi()].state == State::kSettled;
}

// Paths pass it, so that its arcs cannot leave yet, and nothing can change it.
bool LiveGraph::is_bead(const Node& n) const {
  return n.state == State::kSettled && !n.intact && n.degree(kUp) == 1 && n.degree(kDown) == 1 &&
         n.referenced_arcs == 2 && log_ == nullptr;
}

// From the last bead of the arc, or its upper end, to its lower end.
BucketLists::List& LiveGraph::lowest_buckets(Index a) {
  return graph_.arcs[a].beads.empty() ? arc_buckets_[a] : beads_.buckets(graph_.arcs[a].beads.lowest);
}

// The two arcs of a node become one, which is returned, with these beads between them; the node is freed. Every path on
// the upper arc continues on the lower one, since no path ends at a complete vertex.
LiveGraph::Index LiveGraph::join_arcs(Index n, BeadChains::Chain between) {
  const Index upper = graph_.nodes[n].first(kUp), lower = graph_.nodes[n].first(kDown);
  for (Index r = graph_.arcs[upper].first_reference; r != kNone; r = graph_.references[r].next) {
    const Index skipped = graph_.references[r].down;
    graph_.references[r].down = graph_.references[skipped].down;
    graph_.references.free(skipped);
  }
  graph_.arcs[upper].beads = beads_.joined(graph_.arcs[upper].beads, beads_.joined(between, graph_.arcs[lower].beads));
  const Index lo = graph_.arcs[lower].lo();
  graph_.detach(lower);
  graph_.free_arc(lower);
  graph_.detach(upper, kDown);
  graph_.attach(upper, kDown, lo);
  graph_.free_node(n);
  return upper;
}

void LiveGraph::make_bead(Index n) {
  BucketLists::List below;
  if (embeds_) below = std::exchange(arc_buckets_[graph_.nodes[n].first(kDown)], {});
  join_arcs(n, beads_.make(graph_.nodes[n].key, position(n), below));
}

// The bead is a node again. The arc keeps the beads above it; the new arc below it, which is returned, has the others.
LiveGraph::Index LiveGraph::make_node(Index a, Index bead, BeadChains::Chain above, BeadChains::Chain below) {
  const Index n = add_node(beads_.key(bead), beads_.position(bead), State::kSettled), lo = graph_.arcs[a].lo();
  graph_.nodes[n].intact = false;
  graph_.detach(a, kDown);
  graph_.attach(a, kDown, n);
  const Index lower = add_arc(lo, n);
  graph_.arcs[a].beads = above;
  graph_.arcs[lower].beads = below;
  if (embeds_) arc_buckets_[lower] = std::exchange(beads_.buckets(bead), {});
  beads_.free(bead);
  return lower;
}

// No path passes the arc any more. So what is between two of its beads leaves; so does the rest beyond its highest and
// its lowest bead, unless the end there is not settled yet.
void LiveGraph::release_beads(Index a) {
  if (BeadChains::Chain beads = graph_.arcs[a].beads;
      !beads.empty() && graph_.nodes[graph_.arcs[a].hi()].state != State::kSettled) {
    const Index highest = beads_.highest(beads);
    a = make_node(a, highest, {}, beads_.from(beads, beads_.below(beads, highest)));
  }
  if (BeadChains::Chain beads = graph_.arcs[a].beads;
      !beads.empty() && graph_.nodes[graph_.arcs[a].lo()].state != State::kSettled)
    make_node(a, beads.lowest, beads_.without_lowest(beads), {});
  if (can_leave(a)) write_out(a);
}

void LiveGraph::contract(Index n) {
  const Index above = graph_.nodes[n].first(kUp), lower = graph_.nodes[n].first(kDown);
  prefetch_buckets(lower, above);
  prefetch_position(n);
  if (log_ != nullptr) log_->join(lower, above, graph_.nodes[n].key, kDown);
  BucketLists::List* const above_buckets = embeds_ ? &lowest_buckets(above) : nullptr;
  const double value = graph_.nodes[n].key.value;
  const Index upper = join_arcs(n, {});
  const Index lo = graph_.arcs[upper].lo(), hi = graph_.arcs[upper].hi();
  if (embeds_) {
    auto& below = arc_buckets_[lower];
    buckets_.concatenate(below, value, position(n), *above_buckets);
    std::swap(below, *above_buckets);
  }
  noise_.notice(graph_, upper);
  if (noise_.is_noise(graph_, upper)) {  // if an end is a leaf, its saddle has changed
    for (const Index end : {lo, hi})
      if (is_leaf(graph_.nodes[end])) try_leaf(end);
    if (!graph_.nodes[lo].used || !graph_.nodes[hi].used) return;
  }
  if (can_leave(upper)) return write_out(upper);
  if (graph_.arcs[upper].references == 0 && !graph_.arcs[upper].beads.empty()) unreferenced_.push_back(upper);
}

void LiveGraph::settle(Index n) {
  graph_.nodes[n].state = State::kSettled;
  for (const Direction d : {kUp, kDown})
    for (Index a = graph_.nodes[n].first(d); a != kNone;) {
      const Index next = graph_.arcs[a].next(d);
      if (can_leave(a)) write_out(a);
      a = next;
    }
}

void LiveGraph::write_out(Index a) {
  const Index lo = graph_.arcs[a].lo(), hi = graph_.arcs[a].hi();
  if (log_ != nullptr) log_->settle(a);
  SweepKey above = graph_.nodes[hi].key;
  BucketLists::List buckets;  // from there down
  if (embeds_) buckets = std::exchange(arc_buckets_[a], {});
  const auto add_arc_from = [&](const SweepKey& below) {
    settled_.add_arc({below, std::exchange(above, below)});
    if (embeds_) settled_.add_buckets(buckets_, buckets);
  };
  beads_.visit(std::exchange(graph_.arcs[a].beads, {}), [&](Index bead) {
    add_arc_from(beads_.key(bead));
    settled_.add_node({beads_.key(bead), beads_.position(bead)});
    buckets = std::exchange(beads_.buckets(bead), {});
    beads_.free(bead);
    flush_if_many();
  });
  add_arc_from(graph_.nodes[lo].key);
  graph_.detach(a);
  graph_.free_arc(a);
  for (const Index n : {lo, hi}) {
    graph_.nodes[n].intact = false;
    if (graph_.nodes[n].degree() == 0 || is_bead(graph_.nodes[n])) queue(n);
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
  for (Index n = 0; n < graph_.nodes.size(); ++n) {
    const Node& node = graph_.nodes[n];
    if (!node.used || !stays(node)) continue;
    if (node.degree() == 0 && node.intact) isolated.push_back(node.key);
    for (Index a = node.first(kDown); a != kNone; a = graph_.arcs[a].next(kDown)) {
      SweepKey above = node.key;
      const auto add_arc_from = [&](const SweepKey& below) { arcs.push_back({below, std::exchange(above, below)}); };
      Index part = a;
      while (true) {
        beads_.visit(graph_.arcs[part].beads, [&](Index bead) { add_arc_from(beads_.key(bead)); });
        const Node& end = graph_.nodes[graph_.arcs[part].lo()];
        if (stays(end)) break;
        part = end.first(kDown);
      }
      add_arc_from(graph_.nodes[graph_.arcs[part].lo()].key);
    }
  }
}

std::uint64_t LiveGraph::vertex_bound() const {
  std::uint64_t bound = 0;
  const auto include = [&](const SweepKey& key) { bound = std::max(bound, key.vertex.value() + 1); };
  for (const Node& node : graph_.nodes.all())
    if (node.used) include(node.key);
  for (const Arc& arc : graph_.arcs.all())
    if (!arc.is_free()) beads_.visit(arc.beads, [&](Index bead) { include(beads_.key(bead)); });
  return bound;
}

std::size_t LiveGraph::path_arc_count() const {
  std::size_t count = 0;
  for (const Arc& arc : graph_.arcs.all()) {
    if (arc.is_free()) continue;
    count += arc.references;
    beads_.visit(arc.beads, [&](Index) { count += arc.references; });
  }
  return count;
}

std::size_t LiveGraph::memory_bytes() const {
  return graph_.nodes.memory_bytes() + positions_.memory_bytes() + graph_.arcs.memory_bytes() + beads_.memory_bytes() +
         graph_.references.memory_bytes() + (changed_.capacity() + unreferenced_.capacity()) * sizeof(Index) +
         settled_.memory_bytes() + buckets_.memory_bytes() + arc_buckets_.memory_bytes() +
         path_buckets_.capacity() * sizeof(PathBuckets);
}

std::size_t LiveGraph::growth_bytes(std::size_t nodes, std::size_t arcs, std::size_t references,
                                    std::size_t buckets) const {
  const auto beyond_free = [](std::size_t count, const auto& array) {
    return count - std::min(count, array.size() - array.used());
  };
  const std::size_t list = embeds_ ? sizeof(BucketLists::List) : 0, place = track_positions_ ? sizeof(Point) : 0;
  return beyond_free(nodes, graph_.nodes) * (sizeof(Node) + place) +
         beyond_free(arcs, graph_.arcs) * (sizeof(Arc) + list) + beads_.growth_bytes(nodes) +
         beyond_free(references, graph_.references) * sizeof(PathGraph::Reference) + buckets_.growth_bytes(buckets);
}

}  // namespace reeb
