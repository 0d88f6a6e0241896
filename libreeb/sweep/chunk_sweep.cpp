#include "libreeb/sweep/chunk_sweep.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/prefetch.h"
#include "libreeb/sweep/chunk_stars.h"
#include "libreeb/sweep/fragment_builder.h"
#include "libreeb/sweep/shared_edges.h"
#include "libreeb/sweep/vertex_ranks.h"

namespace reeb {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// The triangles that cross the level. Two edges of a triangle t cross it: lo-hi always; lo-mid below its middle vertex
// and mid-hi above it. They are its half-edges 2 * t and 2 * t + 1. Each is in a ring with the half-edges of the other
// triangles at the same mesh edge, if the vertex at its lower end has linked it. Most vertices are regular, and do that
// only when a walk comes to one of their edges.
class Crossings {
 public:
  void reset(std::size_t triangles) { halves_.resize(2 * triangles); }
  // Begins triangle t, neither of whose half-edges is linked.
  void start(std::uint32_t t, std::uint32_t label) {
    halves_[2 * t] = {2 * t + 1, label};
    halves_[2 * t + 1].next = 2 * t;
  }
  // No ring goes from one half-edge of a triangle to the other, so that says: not linked.
  void set_unlinked(std::uint32_t half) { next(half) = half ^ 1; }
  bool is_linked(std::uint32_t half) const { return next(half) != (half ^ 1); }
  std::uint32_t& next(std::uint32_t half) { return halves_[half].next; }
  std::uint32_t next(std::uint32_t half) const { return halves_[half].next; }
  std::uint32_t& label(std::uint32_t t) { return halves_[2 * std::size_t{t}].label; }
  std::uint32_t label(std::uint32_t t) const { return halves_[2 * std::size_t{t}].label; }
  // Prefetches label and rings of the triangle of a half-edge.
  void prefetch(std::uint32_t half) const { reeb::prefetch(&halves_[half & ~1u]); }
  std::size_t memory_bytes() const { return halves_.capacity() * sizeof(Half); }

 private:
  // Label and rings of a triangle are next to each other, since a walk reads all of them.
  struct Half {
    std::uint32_t next;
    std::uint32_t label;  // of the triangle, in its first half-edge
  };
  std::vector<Half> halves_;
};

// The edges up from the current vertex, numbered in order of discovery, and their groups: edges that are connected by
// triangles with the vertex as lowest corner.
class UpwardEdges {
 public:
  void reset(std::size_t vertices) {
    fill_with_room(edge_of_, vertices, 0u);
    first_ = 1;
    count_ = linked_ = 0;
  }
  // Finds the edges up from v, links their half-edges into rings, and unites the edges of each triangle.
  void collect(std::uint32_t v, const ChunkStars& stars, Crossings& crossings) {
    const std::uint32_t low_first = stars.low_first(v), low_last = stars.low_last(v);
    const auto middles = stars.middles(v);
    const std::size_t most = middles.size() + 2 * std::size_t{low_last - low_first};
    if (edges_.size() < most) edges_.resize(most);
    const std::uint32_t first = first_ + count_ + linked_;
    std::uint32_t count = 0, groups = 0;  // locals stay in registers: no write through a pointer can change them

    // Enters a half-edge up to `hi` and links it into the ring of its edge; returns the edge.
    const auto touch = [&](std::uint32_t hi, std::uint32_t half) {
      std::uint32_t& number = edge_of_[hi];
      if (number >= first) {
        const std::uint32_t e = number - first;
        crossings.next(half) = std::exchange(crossings.next(edges_[e].head), half);
        return e;
      }
      const std::uint32_t e = count++;
      number = first + e;
      edges_[e] = {hi, half, e};
      crossings.next(half) = half;
      ++groups;
      return e;
    };
    for (const std::uint32_t t : middles) touch(stars.hi(t), 2 * t + 1);
    for (std::uint32_t t = low_first; t < low_last; ++t) {
      const std::uint32_t to_hi = touch(stars.hi(t), 2 * t);
      if (stars.mid(t) == stars.hi(t))
        crossings.next(2 * t + 1) = 2 * t + 1;
      else if (unite(to_hi, touch(stars.mid(t), 2 * t + 1)))
        --groups;
    }
    first_ = first;
    count_ = count;
    groups_ = groups;
    linked_ = 0;
  }

  // Links the half-edges up from w that cross the level just above v, in the same order as collect(w). REQUIRES: w was
  // passed without collect(w). Edges of v cannot be found by their upper ends any more.
  void link_late(std::uint32_t w, std::uint32_t v, const ChunkStars& stars, Crossings& crossings) {
    const auto touch = [&](std::uint32_t hi, std::uint32_t half) {
      std::uint32_t& number = edge_of_[hi];
      const std::uint32_t first_of_w = first_ + count_ + linked_ - static_cast<std::uint32_t>(late_heads_.size());
      if (number >= first_of_w) {
        crossings.next(half) = std::exchange(crossings.next(late_heads_[number - first_of_w]), half);
        return;
      }
      number = first_ + count_ + linked_++;
      late_heads_.push_back(half);
      crossings.next(half) = half;
    };
    late_heads_.clear();
    for (const std::uint32_t t : stars.middles(w)) touch(stars.hi(t), 2 * t + 1);
    for (std::uint32_t t = stars.low_first(w); t < stars.low_last(w); ++t) {
      const std::uint32_t mid = stars.mid(t), hi = stars.hi(t);
      touch(hi, 2 * t);
      if (mid == hi)
        crossings.next(2 * t + 1) = 2 * t + 1;
      else if (mid > v)  // else the half-edge is that from mid to hi
        touch(mid, 2 * t + 1);
    }
  }

  std::uint32_t count() const { return count_; }
  std::uint32_t groups() const { return groups_; }
  std::uint32_t hi(std::uint32_t e) const { return edges_[e].hi; }
  std::uint32_t head(std::uint32_t e) const { return edges_[e].head; }
  // The edge that represents the group of e.
  std::uint32_t group(std::uint32_t e) {
    while (edges_[e].parent != e) e = edges_[e].parent = edges_[edges_[e].parent].parent;
    return e;
  }
  std::uint32_t group_of_neighbour(std::uint32_t hi) { return group(edge_of_[hi] - first_); }
  std::size_t memory_bytes() const {
    return 4 * (edge_of_.capacity() + late_heads_.capacity()) + edges_.capacity() * sizeof(Edge);
  }

 private:
  struct Edge {
    std::uint32_t hi, head, parent;
  };

  // True if they were in different groups.
  bool unite(std::uint32_t a, std::uint32_t b) {
    a = group(a);
    b = group(b);
    edges_[std::max(a, b)].parent = std::min(a, b);
    return a != b;
  }

  // By rank: first_ + edge; less than first_: of an earlier vertex; more than that: of a vertex that was linked late.
  std::vector<std::uint32_t> edge_of_;
  std::uint32_t first_ = 1;
  std::vector<Edge> edges_;  // count_ of them
  std::uint32_t count_ = 0, groups_ = 0;
  std::uint32_t linked_ = 0;               // edges that were linked late since then
  std::vector<std::uint32_t> late_heads_;  // of their last vertex
};

// Labels of crossing triangles, and the arc of each set of labels.
class Labels {
 public:
  void clear() { labels_.clear(); }
  std::uint32_t count() const { return static_cast<std::uint32_t>(labels_.size()); }
  std::uint32_t add(SweepArc arc) {
    labels_.push_back({count(), arc, 0});
    return count() - 1;
  }
  std::uint32_t find(std::uint32_t x) {
    while (labels_[x].parent != x) x = labels_[x].parent = labels_[labels_[x].parent].parent;
    return x;
  }
  bool is_root(std::uint32_t x) const { return labels_[x].parent == x; }
  void merge_into(std::uint32_t root, std::uint32_t other) { labels_[other].parent = root; }
  SweepArc& arc(std::uint32_t root) { return labels_[root].arc; }
  // True in the first call for this root at v.
  bool mark(std::uint32_t root, std::uint32_t v) { return std::exchange(labels_[root].marked, v + 1) != v + 1; }
  std::size_t memory_bytes() const { return labels_.capacity() * sizeof(Label); }

 private:
  struct Label {
    std::uint32_t parent;
    SweepArc arc;
    std::uint32_t marked;  // 1 + the last vertex at which it was marked
  };
  std::vector<Label> labels_;
};

// One group of upward edges during a walk. It enters triangles through half-edges: those of the queue, from `visited`
// on, are still to be entered.
struct Side {
  std::vector<std::uint32_t> queue;
  std::size_t visited = 0;
  std::vector<std::uint32_t> shared;  // the triangles entered that have a shared edge
  bool exhausted = false, met = false;

  void start() {
    queue.clear();
    visited = 0;
    shared.clear();
    exhausted = met = false;
  }
  bool has_pending() const { return visited < queue.size(); }
  void take_pending(Side& other) {
    const auto first = other.queue.begin() + static_cast<std::ptrdiff_t>(other.visited);
    queue.insert(queue.end(), first, other.queue.end());
  }
};

}  // namespace

struct ChunkSweep::Scratch {
  void run(const Chunk& chunk_in, std::span<const double> values, const SweepOptions& options, Fragment& fragment);
  std::size_t memory_bytes() const;

 private:
  void reset(const SweepOptions& options);
  void find_uses();
  void visit(std::uint32_t v);
  bool pass_regular(std::uint32_t v);
  void collect_below(std::uint32_t v);
  void end_arcs_below(SweepNode node);
  void label_lows(std::uint32_t v, std::uint32_t label);
  void start_arcs(std::uint32_t v, SweepNode node);
  SweepArc join_below(SweepNode node);
  void continue_as_one(std::uint32_t v, SweepNode node);
  void separate(std::uint32_t v, SweepNode node);
  void note_branches(std::uint32_t v, const Side& side, SweepNode node, SweepArc arc);
  void add_shared_edges(std::uint32_t v, SweepNode node);
  void check_edges(std::uint32_t v) const;

  std::size_t walk(std::uint32_t v);
  void seed_sides(std::uint32_t v);
  void step(std::uint32_t side);
  void link(std::uint32_t half);
  void meet(std::uint32_t side, std::uint32_t label);
  void enter(std::uint32_t t, std::uint32_t side) {
    crossings.label(t) = first_side + side;
    if (has_shared_edge[t]) sides[side].shared.push_back(t);
  }
  // Goes on to the next triangle at the edge of this half-edge.
  void leave(std::uint32_t half, Side& side) {
    if (!crossings.is_linked(half)) [[unlikely]]
      link(half);
    const std::uint32_t beyond = crossings.next(half);
    if (beyond == half) return;
    crossings.prefetch(beyond);
    side.queue.push_back(beyond);
  }

  void note_regular(std::uint32_t v, std::uint32_t label_root) {
    builder.note_regular(labels.arc(label_root), LocalVertex(ranks.order()[v]));
  }
  void note_if_shared(std::uint32_t lo, std::uint32_t hi, SweepNode node, SweepArc arc) {
    if ((uses[lo] & uses[hi]) != 0) shared_edges.note_branch(VertexRank(lo), VertexRank(hi), node, arc);
  }

  const Chunk* chunk = nullptr;
  std::uint32_t current = 0;  // the last vertex for which pass_regular() was false
  const SweptChunk* swept = nullptr;
  bool notes_regular = false, manifold = false;
  VertexRanks ranks;
  ChunkStars stars;
  FragmentBuilder builder;
  SharedEdges shared_edges;

  std::vector<std::uint8_t> uses;     // by rank
  std::vector<bool> has_shared_edge;  // by triangle
  Crossings crossings;                // by triangle
  Labels labels;
  UpwardEdges up;
  std::vector<std::uint32_t> below;    // label roots of the arcs that reach v
  std::vector<SweepArc> group_arc;     // by upward edge that represents its group
  std::vector<std::uint32_t> side_of;  // by upward edge that represents its group

  // The current walk. Side s has the label first_side + s; sides that met have the same root.
  std::vector<Side> sides;
  std::uint32_t first_side = 0;
  std::vector<std::uint32_t> active;  // sides that are not known to be exhausted or to have met another
};

ChunkSweep::ChunkSweep() : scratch_(std::make_unique<Scratch>()) {}
ChunkSweep::~ChunkSweep() = default;
ChunkSweep::ChunkSweep(ChunkSweep&&) noexcept = default;
ChunkSweep& ChunkSweep::operator=(ChunkSweep&&) noexcept = default;

void ChunkSweep::run(const Chunk& chunk, std::span<const double> values, Fragment& fragment,
                     const SweepOptions& options) {
  scratch_->run(chunk, values, options, fragment);
}

std::size_t ChunkSweep::memory_bytes() const { return scratch_->memory_bytes(); }

void ChunkSweep::Scratch::run(const Chunk& chunk_in, std::span<const double> values, const SweepOptions& options,
                              Fragment& fragment) {
  chunk = &chunk_in;
  ranks.sort(values, chunk->ids);
  stars.build(*chunk, ranks.order());
  reset(options);
  const SweptChunk swept_chunk{*chunk, values, ranks.order(), &stars};
  swept = &swept_chunk;
  const auto n = static_cast<std::uint32_t>(chunk->vertex_count());
  for (std::uint32_t v = 0; v < n; ++v) visit(v);
  builder.end_sweep(swept_chunk);
  builder.finish(swept_chunk, shared_edges, fragment);
}

void ChunkSweep::Scratch::reset(const SweepOptions& options) {
  const std::size_t n = chunk->vertex_count();
  find_uses();
  crossings.reset(stars.triangle_count());
  notes_regular = options.notes_regular();
  manifold = options.manifold;
  labels.clear();
  up.reset(n);
  builder.start(n, options);
  shared_edges.start(n);
}

void ChunkSweep::Scratch::find_uses() {
  const auto n = static_cast<std::uint32_t>(chunk->vertex_count());
  uses.resize(n);
  for (std::uint32_t r = 0; r < n; ++r) uses[r] = chunk->uses[ranks.order()[r]];
  has_shared_edge.assign(stars.triangle_count(), false);
  for (std::uint32_t r = 0; r < n; ++r) {
    if (uses[r] == kUsedHereOnly) continue;
    for (std::uint32_t t = stars.low_first(r); t < stars.low_last(r); ++t)
      if ((uses[r] & (uses[stars[t].mid] | uses[stars[t].hi])) != 0) has_shared_edge[t] = true;
    for (const std::uint32_t t : stars.middles(r))
      if ((uses[r] & uses[stars[t].hi]) != 0) has_shared_edge[t] = true;
  }
}

std::size_t ChunkSweep::Scratch::memory_bytes() const {
  std::size_t walked = sides.capacity() * sizeof(Side) + has_shared_edge.capacity() / 8;
  for (const Side& side : sides) walked += 4 * (side.queue.capacity() + side.shared.capacity());
  return ranks.memory_bytes() + stars.memory_bytes() + builder.memory_bytes() + shared_edges.memory_bytes() +
         uses.capacity() + crossings.memory_bytes() + labels.memory_bytes() + up.memory_bytes() + walked;
}

void ChunkSweep::Scratch::visit(std::uint32_t v) {
  shared_edges.reach(VertexRank(v));
  if (pass_regular(v)) return;
  current = v;
  collect_below(v);
  up.collect(v, stars, crossings);
  if (manifold) check_edges(v);
  const bool walks = up.groups() > 1 && !below.empty();
  const bool joined = up.groups() == 1 || (walks && walk(v) == 1);
  const bool shared = (uses[v] & ~unsigned{kCountedElsewhere}) != 0;
  if (joined && below.size() == 1 && !shared) {  // a regular vertex
    label_lows(v, below[0]);
    if (notes_regular && uses[v] == kUsedHereOnly) note_regular(v, below[0]);
    return;
  }
  const SweepNode node = builder.add_node(VertexRank(v));
  end_arcs_below(node);
  if (joined)
    continue_as_one(v, node);
  else if (below.empty())
    start_arcs(v, node);
  else if (walks)
    separate(v, node);
  else if (below.size() == 1)
    builder.note_leaf(node, labels.arc(below[0]));
  if (shared) add_shared_edges(v, node);
}

// If v is a regular vertex with a small star, as most vertices of a smooth function are, does all that is to be done
// for it, and returns true. The loops have a fixed length, since another could not be predicted. Where the star is
// smaller, they do something twice.
bool ChunkSweep::Scratch::pass_regular(std::uint32_t v) {
  constexpr std::size_t kMostBelow = 5;
  constexpr std::uint32_t kMostLows = 3;
  const auto triangles_below = stars.middles_and_highs(v);
  const std::size_t last_below = triangles_below.size() - 1;
  if (uses[v] != kUsedHereOnly || last_below >= kMostBelow || !stars.is_small_and_connected_above(v, manifold))
    return false;
  const std::uint32_t label = crossings.label(triangles_below[0]);
  std::uint32_t differs = 0;
  for (std::size_t i = 1; i < kMostBelow; ++i)
    differs |= label ^ crossings.label(triangles_below[std::min(i, last_below)]);
  const std::uint32_t root = labels.find(label);
  if (differs != 0)
    for (const std::uint32_t t : triangles_below)
      if (labels.find(crossings.label(t)) != root) return false;
  const auto middles = stars.middles(v);
  crossings.set_unlinked(2 * middles.front() + 1);
  crossings.set_unlinked(2 * middles.back() + 1);
  const std::uint32_t low_first = stars.low_first(v), last_low = stars.low_last(v) - 1;
  for (std::uint32_t i = 0; i < kMostLows; ++i) crossings.start(std::min(low_first + i, last_low), root);
  if (notes_regular) note_regular(v, root);
  return true;
}

// The distinct arcs of the triangles in which v is middle or highest all end or meet in v.
void ChunkSweep::Scratch::collect_below(std::uint32_t v) {
  below.clear();
  std::uint32_t last = kNone;
  for (const std::uint32_t t : stars.middles_and_highs(v)) {
    const std::uint32_t label = crossings.label(t);
    if (label == last) continue;
    last = label;
    const std::uint32_t root = labels.find(label);
    if (labels.mark(root, v)) below.push_back(root);
  }
}

void ChunkSweep::Scratch::end_arcs_below(SweepNode node) {
  for (const std::uint32_t root : below) builder.end_arc(labels.arc(root), node);
}

void ChunkSweep::Scratch::label_lows(std::uint32_t v, std::uint32_t label) {
  for (std::uint32_t t = stars.low_first(v); t < stars.low_last(v); ++t) crossings.label(t) = label;
}

// v has nothing below it: each group is a contour of its own.
void ChunkSweep::Scratch::start_arcs(std::uint32_t v, SweepNode node) {
  group_arc.resize(up.count());
  side_of.resize(up.count());  // holds the label of the group here
  for (std::uint32_t e = 0; e < up.count(); ++e) {
    if (up.group(e) != e) continue;
    group_arc[e] = builder.add_arc(node);
    side_of[e] = labels.add(group_arc[e]);
  }
  for (std::uint32_t t = stars.low_first(v); t < stars.low_last(v); ++t)
    crossings.label(t) = side_of[up.group_of_neighbour(stars.hi(t))];
}

// All arcs from below continue as one new arc, which is returned.
SweepArc ChunkSweep::Scratch::join_below(SweepNode node) {
  const SweepArc arc = builder.add_arc(node);
  if (below.empty()) below.push_back(labels.add(arc));
  for (std::size_t i = 1; i < below.size(); ++i) labels.merge_into(below[0], below[i]);
  labels.arc(below[0]) = arc;
  builder.set_main_branch(node, arc);
  return arc;
}

void ChunkSweep::Scratch::continue_as_one(std::uint32_t v, SweepNode node) {
  const bool is_leaf = below.empty();
  const SweepArc arc = join_below(node);
  if (is_leaf) builder.note_leaf(node, arc);
  group_arc.assign(up.count(), arc);
  label_lows(v, below[0]);
}

// v splits: the side that was not exhausted keeps the labels from below, each of the others has its own.
void ChunkSweep::Scratch::separate(std::uint32_t v, SweepNode node) {
  const SweepArc main_arc = join_below(node);
  for (std::uint32_t s = 0; s < up.groups(); ++s)
    if (sides[s].exhausted) labels.arc(first_side + s) = builder.add_arc(node);
  for (std::uint32_t s = 0; s < up.groups(); ++s)
    if (const SweepArc arc = labels.arc(labels.find(first_side + s)); arc != main_arc)
      note_branches(v, sides[s], node, arc);
  group_arc.resize(up.count());
  for (std::uint32_t e = 0; e < up.count(); ++e)
    if (up.group(e) == e) group_arc[e] = labels.arc(labels.find(first_side + side_of[e]));
}

// The paths of shared edges that cross the level on this side do not take the main branch.
void ChunkSweep::Scratch::note_branches(std::uint32_t v, const Side& side, SweepNode node, SweepArc arc) {
  for (const std::uint32_t t : side.shared) {
    const auto& [lo, mid, hi, place] = stars[t];
    if (lo == v) continue;
    note_if_shared(lo, hi, node, arc);
    if (mid < v)
      note_if_shared(mid, hi, node, arc);
    else if (mid > v)
      note_if_shared(lo, mid, node, arc);
  }
}

void ChunkSweep::Scratch::add_shared_edges(std::uint32_t v, SweepNode node) {
  for (std::uint32_t e = 0; e < up.count(); ++e) {
    if ((uses[v] & uses[up.hi(e)]) == 0) continue;
    if (manifold && crossings.next(up.head(e)) != up.head(e)) {
      shared_edges.add_closed(node, VertexRank(up.hi(e)));
      continue;
    }
    std::uint32_t place = 0, half = up.head(e);
    do {
      place = std::max(place, stars[half / 2].place);
      half = crossings.next(half);
    } while (half != up.head(e));
    shared_edges.add(node, VertexRank(up.hi(e)), group_arc[up.group(e)], place);
  }
  shared_edges.finish_vertex(VertexRank(v));
}

// No ring of an edge up from v has more than two triangles.
void ChunkSweep::Scratch::check_edges(std::uint32_t v) const {
  for (std::uint32_t e = 0; e < up.count(); ++e) {
    const std::uint32_t head = up.head(e);
    if (crossings.next(crossings.next(head)) != head)
      throw not_manifold(swept->key(VertexRank(v)).vertex.value(), swept->key(VertexRank(up.hi(e))).vertex.value());
  }
}

// Walks the level set just above v from all groups in lockstep until all but one are exhausted or have met another.
// Returns the number of sides: the exhausted ones and the remaining one. The work is proportional to the size of the
// exhausted sides, plus at most the same work on the remaining side.
std::size_t ChunkSweep::Scratch::walk(std::uint32_t v) {
  seed_sides(v);
  std::size_t exhausted = 0;
  while (active.size() > 1) {
    for (std::size_t i = 0; i < active.size() && active.size() > 1;) {
      const std::uint32_t s = active[i];
      Side& side = sides[s];
      if (!side.met && side.has_pending()) {
        step(s);
        ++i;
        continue;
      }
      if (!side.met) {
        side.exhausted = true;
        ++exhausted;
      }
      active[i] = active.back();
      active.pop_back();
    }
  }
  labels.merge_into(below[0], first_side + active[0]);
  return exhausted + 1;
}

void ChunkSweep::Scratch::seed_sides(std::uint32_t v) {
  active.clear();
  side_of.resize(up.count());
  if (sides.size() < up.groups()) sides.resize(up.groups());
  first_side = labels.count();
  for (std::uint32_t e = 0; e < up.count(); ++e) {
    if (up.group(e) != e) continue;
    side_of[e] = labels.add(SweepArc::none()) - first_side;
    active.push_back(side_of[e]);
    sides[side_of[e]].start();
  }
  for (const std::uint32_t t : stars.middles(v)) enter(t, side_of[up.group_of_neighbour(stars.hi(t))]);
  for (std::uint32_t t = stars.low_first(v); t < stars.low_last(v); ++t)
    enter(t, side_of[up.group_of_neighbour(stars.hi(t))]);
  // The other triangles at an edge up from v are in the same group. Now that edges can be linked late: no edge of v is
  // looked up any more.
  for (const std::uint32_t t : stars.middles(v)) leave(2 * t, sides[crossings.label(t) - first_side]);
}

// Enters one triangle. Of the other triangles at a crossing edge, only the next one in the ring is examined. Since that
// is done from every triangle, the walk reaches all of them. The cost per triangle is constant, however many share an
// edge. Mostly an edge has two triangles, and the next one at the edge of entry is where the walk came from.
void ChunkSweep::Scratch::step(std::uint32_t s) {
  Side& side = sides[s];
  const std::uint32_t half = side.queue[side.visited++];
  const std::uint32_t label = crossings.label(half / 2);
  if (label >= first_side) return meet(s, label);
  enter(half / 2, s);
  leave(half ^ 1, side);
  if (crossings.next(crossings.next(half)) != half) leave(half, side);
}

// Side s arrives at a triangle with this label of the walk. Both sides are active: no step leads from an exhausted side
// to another one. The current side stays.
void ChunkSweep::Scratch::meet(std::uint32_t s, std::uint32_t label) {
  const std::uint32_t there = labels.find(label) - first_side;
  if (there == s) return;
  labels.merge_into(first_side + s, first_side + there);
  sides[there].met = true;
  sides[s].take_pending(sides[there]);
}

// Links the half-edges of a vertex that was passed without that: of the lower end of this one.
void ChunkSweep::Scratch::link(std::uint32_t half) {
  const auto [lo, mid, hi, place] = stars[half / 2];
  const bool from_mid = half % 2 != 0 && mid <= current;
  up.link_late(from_mid ? mid : lo, current, stars, crossings);
}

}  // namespace reeb
