#include "libreeb/engine/chunk_sweep.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "libreeb/engine/chunk_stars.h"
#include "libreeb/engine/fragment_builder.h"
#include "libreeb/engine/vertex_ranks.h"

namespace reeb {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// A half-edge is an edge of a triangle: 3 * t + which.
constexpr std::uint32_t kLoMid = 0, kLoHi = 1, kMidHi = 2;

// The edges up from the vertex at hand, numbered in order of discovery, and their groups: edges
// that triangles with the vertex as lowest corner hold together.
class UpwardEdges {
 public:
  void reset(std::size_t vertices) {
    edge_of_.assign(vertices, 0);
    first_ = 1;
    clear();
  }
  void clear() {
    first_ += static_cast<std::uint32_t>(hi_.size());
    hi_.clear();
    head_.clear();
    parent_.clear();
    groups_ = 0;
  }

  // Enters a half-edge up to `hi` and links it into the ring of its edge; returns the edge.
  std::uint32_t touch(std::uint32_t hi, std::uint32_t half, std::vector<std::uint32_t>& ring) {
    if (edge_of_[hi] >= first_) {
      const std::uint32_t e = edge_of_[hi] - first_;
      ring[half] = std::exchange(ring[head_[e]], half);
      return e;
    }
    const auto e = static_cast<std::uint32_t>(hi_.size());
    edge_of_[hi] = first_ + e;
    hi_.push_back(hi);
    head_.push_back(half);
    parent_.push_back(e);
    ring[half] = half;
    ++groups_;
    return e;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = group(a);
    b = group(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --groups_;
  }

  std::size_t memory_bytes() const { return 4 * edge_of_.capacity(); }
  std::uint32_t count() const { return static_cast<std::uint32_t>(hi_.size()); }
  std::uint32_t groups() const { return groups_; }
  std::uint32_t hi(std::uint32_t e) const { return hi_[e]; }
  std::uint32_t head(std::uint32_t e) const { return head_[e]; }
  // The edge that stands for the group of e.
  std::uint32_t group(std::uint32_t e) {
    while (parent_[e] != e) e = parent_[e] = parent_[parent_[e]];
    return e;
  }
  std::uint32_t group_of_neighbour(std::uint32_t hi) { return group(edge_of_[hi] - first_); }

 private:
  std::vector<std::uint32_t> edge_of_;  // by rank; valid if >= first_
  std::uint32_t first_ = 1;
  std::vector<std::uint32_t> hi_, head_, parent_;
  std::uint32_t groups_ = 0;
};

// Labels of crossing triangles, and which arc each set of labels stands for.
class Labels {
 public:
  void clear() {
    parent_.clear();
    arc_.clear();
    mark_.clear();
  }
  std::uint32_t add(std::uint32_t arc) {
    parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
    arc_.push_back(arc);
    mark_.push_back(0);
    return parent_.back();
  }
  std::uint32_t find(std::uint32_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void merge_into(std::uint32_t root, std::uint32_t other) { parent_[other] = root; }
  std::uint32_t& arc(std::uint32_t root) { return arc_[root]; }
  std::uint32_t& mark(std::uint32_t root) { return mark_[root]; }
  std::size_t memory_bytes() const { return 12 * parent_.capacity(); }

 private:
  std::vector<std::uint32_t> parent_, arc_, mark_;
};

// A list of triangles threaded through one shared array.
struct TriangleList {
  std::uint32_t head = kNone, tail = kNone;

  bool empty() const { return head == kNone; }
  void append(std::uint32_t t, std::vector<std::uint32_t>& next) {
    next[t] = kNone;
    (empty() ? head : next[tail]) = t;
    tail = t;
  }
  std::uint32_t pop(const std::vector<std::uint32_t>& next) {
    return std::exchange(head, next[head]);
  }
  void splice(TriangleList& other, std::vector<std::uint32_t>& next) {
    if (other.empty()) return;
    (empty() ? head : next[tail]) = other.head;
    tail = other.tail;
    other = {};
  }
};

}  // namespace

struct ChunkSweep::Scratch {
  void run(const Chunk& chunk_in, std::span<const double> values, Fragment& fragment);
  std::size_t memory_bytes() const;

 private:
  // One group of upward edges during a walk.
  struct Side {
    std::uint32_t parent;  // a side that it met, or itself
    bool exhausted = false;
    TriangleList pending, visited;
    std::uint32_t arc = kNone;  // that leaves through it; kNone: the side that was not exhausted
  };

  void reset();
  void visit(std::uint32_t v);
  void collect_below(std::uint32_t v);
  void group_above(std::uint32_t v);
  void end_arcs_below(std::uint32_t node);
  void label_lows(std::uint32_t v, std::uint32_t new_label);
  void start_arcs(std::uint32_t v, std::uint32_t node);
  void continue_as_one(std::uint32_t v, std::uint32_t node);
  void separate(std::uint32_t v, std::uint32_t node);
  void add_shared_edges(std::uint32_t v, std::uint32_t node);

  std::size_t walk(std::uint32_t v);
  void seed_sides(std::uint32_t v);
  void step(std::uint32_t v, std::uint32_t side);
  void enter(std::uint32_t t, std::uint32_t side);
  std::uint32_t find_side(std::uint32_t s) {
    while (sides[s].parent != s) s = sides[s].parent = sides[sides[s].parent].parent;
    return s;
  }
  // The second edge of t that crosses the level just above v; the first is always kLoHi.
  std::uint32_t second_crossing(std::uint32_t t, std::uint32_t v) const {
    return stars.mid[t] <= v ? kMidHi : kLoMid;
  }

  std::uint8_t uses(std::uint32_t v) const { return chunk->uses[ranks.order()[v]]; }
  void note_if_shared(std::uint32_t lo, std::uint32_t hi, std::uint32_t node, std::uint32_t arc) {
    if ((uses(lo) & uses(hi)) != 0) builder.note_branch(lo, hi, node, arc);
  }

  const Chunk* chunk = nullptr;
  VertexRanks ranks;
  ChunkStars stars;
  FragmentBuilder builder;

  std::vector<std::uint32_t> ring;   // by half-edge: the next half-edge of the same mesh edge
  std::vector<std::uint32_t> label;  // by triangle, while it crosses the level
  std::vector<std::uint32_t> next;   // by triangle: TriangleList
  std::vector<std::uint32_t> owner;  // by triangle: owner_base + side, if visited in this walk
  std::uint32_t owner_base = 1;
  Labels labels;
  UpwardEdges up;
  std::vector<std::uint32_t> below;      // label roots of the arcs that reach v
  std::vector<std::uint32_t> group_arc;  // by upward edge that stands for its group
  std::vector<Side> sides;
  std::vector<std::uint32_t> side_of;    // by upward edge that stands for its group
  std::vector<std::uint32_t> active;     // sides that may be neither exhausted nor met
};

ChunkSweep::ChunkSweep() : scratch_(std::make_unique<Scratch>()) {}
ChunkSweep::~ChunkSweep() = default;
ChunkSweep::ChunkSweep(ChunkSweep&&) noexcept = default;
ChunkSweep& ChunkSweep::operator=(ChunkSweep&&) noexcept = default;

void ChunkSweep::run(const Chunk& chunk, std::span<const double> values, Fragment& fragment) {
  scratch_->run(chunk, values, fragment);
}

std::size_t ChunkSweep::memory_bytes() const { return scratch_->memory_bytes(); }

void ChunkSweep::Scratch::run(const Chunk& chunk_in, std::span<const double> values, Fragment& fragment) {
  chunk = &chunk_in;
  ranks.sort(values, chunk->ids);
  stars.build(*chunk, ranks.order());
  reset();
  const auto n = static_cast<std::uint32_t>(chunk->vertex_count());
  for (std::uint32_t v = 0; v < n; ++v) visit(v);
  builder.finish({*chunk, values, ranks.order(), stars}, fragment);
}

void ChunkSweep::Scratch::reset() {
  const std::size_t m = stars.triangle_count();
  ring.resize(3 * m);
  label.resize(m);
  next.resize(m);
  owner.assign(m, 0);
  owner_base = 1;
  labels.clear();
  up.reset(chunk->vertex_count());
  builder.start(chunk->vertex_count());
}

std::size_t ChunkSweep::Scratch::memory_bytes() const {
  return ranks.memory_bytes() + stars.memory_bytes() + builder.memory_bytes() +
         4 * (ring.capacity() + label.capacity() + next.capacity() + owner.capacity()) +
         labels.memory_bytes() + up.memory_bytes();
}

void ChunkSweep::Scratch::visit(std::uint32_t v) {
  builder.reach(v);
  collect_below(v);
  group_above(v);
  const bool joined = up.groups() == 1 || (up.groups() > 1 && !below.empty() && walk(v) == 1);
  const bool shared = uses(v) != kUsedHereOnly;
  if (joined && below.size() == 1 && !shared) {  // a regular vertex
    label_lows(v, below[0]);
    return;
  }
  const std::uint32_t node = builder.add_node(v);
  end_arcs_below(node);
  if (joined)
    continue_as_one(v, node);
  else if (below.empty())
    start_arcs(v, node);
  else if (up.groups() > 1)
    separate(v, node);
  if (shared) add_shared_edges(v, node);
}

// The distinct arcs of the triangles in which v is middle or highest all end or meet in v.
void ChunkSweep::Scratch::collect_below(std::uint32_t v) {
  below.clear();
  const auto collect = [&](std::span<const std::uint32_t> triangles) {
    for (const std::uint32_t t : triangles) {
      const std::uint32_t root = labels.find(label[t]);
      if (labels.mark(root) == v + 1) continue;
      labels.mark(root) = v + 1;
      below.push_back(root);
    }
  };
  collect(stars.middles(v));
  collect(stars.highs(v));
}

void ChunkSweep::Scratch::group_above(std::uint32_t v) {
  up.clear();
  for (const std::uint32_t t : stars.middles(v)) up.touch(stars.hi[t], 3 * t + kMidHi, ring);
  for (std::uint32_t t = stars.low_first(v); t < stars.low_last(v); ++t) {
    const std::uint32_t to_hi = up.touch(stars.hi[t], 3 * t + kLoHi, ring);
    if (stars.mid[t] == stars.hi[t])
      ring[3 * t + kLoMid] = 3 * t + kLoMid;
    else
      up.unite(to_hi, up.touch(stars.mid[t], 3 * t + kLoMid, ring));
  }
}

void ChunkSweep::Scratch::end_arcs_below(std::uint32_t node) {
  for (const std::uint32_t root : below) builder.end_arc(labels.arc(root), node);
}

void ChunkSweep::Scratch::label_lows(std::uint32_t v, std::uint32_t new_label) {
  for (std::uint32_t t = stars.low_first(v); t < stars.low_last(v); ++t) label[t] = new_label;
}

// Nothing hangs below v: each group is a contour of its own.
void ChunkSweep::Scratch::start_arcs(std::uint32_t v, std::uint32_t node) {
  group_arc.resize(up.count());
  side_of.resize(up.count());  // here: the label of the group
  for (std::uint32_t e = 0; e < up.count(); ++e) {
    if (up.group(e) != e) continue;
    group_arc[e] = builder.add_arc(node);
    side_of[e] = labels.add(group_arc[e]);
  }
  for (std::uint32_t t = stars.low_first(v); t < stars.low_last(v); ++t)
    label[t] = side_of[up.group_of_neighbour(stars.hi[t])];
}

void ChunkSweep::Scratch::continue_as_one(std::uint32_t v, std::uint32_t node) {
  const std::uint32_t arc = builder.add_arc(node);
  if (below.empty()) below.push_back(labels.add(arc));
  const std::uint32_t root = below[0];
  for (std::size_t i = 1; i < below.size(); ++i) labels.merge_into(root, below[i]);
  labels.arc(root) = arc;
  label_lows(v, root);
  group_arc.assign(up.count(), arc);
  builder.set_main_branch(node, arc);
}

// v splits: the side that was not exhausted keeps its labels, all others are relabelled.
void ChunkSweep::Scratch::separate(std::uint32_t v, std::uint32_t node) {
  continue_as_one(v, node);
  for (Side& side : sides) {
    if (!side.exhausted) continue;
    side.arc = builder.add_arc(node);
    const std::uint32_t fresh = labels.add(side.arc);
    for (std::uint32_t t = side.visited.head; t != kNone; t = next[t]) {
      label[t] = fresh;
      if (stars.lo[t] == v) continue;
      note_if_shared(stars.lo[t], stars.hi[t], node, side.arc);
      if (stars.mid[t] < v)
        note_if_shared(stars.mid[t], stars.hi[t], node, side.arc);
      else if (stars.mid[t] > v)
        note_if_shared(stars.lo[t], stars.mid[t], node, side.arc);
    }
  }
  for (std::uint32_t e = 0; e < up.count(); ++e) {
    if (up.group(e) != e) continue;
    const Side& side = sides[find_side(side_of[e])];
    if (side.exhausted) group_arc[e] = side.arc;
  }
}

void ChunkSweep::Scratch::add_shared_edges(std::uint32_t v, std::uint32_t node) {
  for (std::uint32_t e = 0; e < up.count(); ++e) {
    if ((uses(v) & uses(up.hi(e))) == 0) continue;
    std::uint32_t place = 0, half = up.head(e);
    do {
      place = std::max(place, stars.place[half / 3]);
      half = ring[half];
    } while (half != up.head(e));
    builder.add_shared_edge(node, up.hi(e), group_arc[up.group(e)], place);
  }
  builder.finish_shared_edges_of(v);
}

// Walks the level set just above v from all groups in lockstep until all but one are exhausted or
// met. Returns the number of sides: the exhausted ones and the one that is left. The work is a
// constant times what the exhausted sides hold, and at most as much again on the last.
std::size_t ChunkSweep::Scratch::walk(std::uint32_t v) {
  seed_sides(v);
  std::size_t exhausted = 0;
  while (active.size() > 1) {
    for (std::size_t i = 0; i < active.size() && active.size() > 1;) {
      const std::uint32_t s = active[i];
      const bool met = sides[s].parent != s;
      if (!met && !sides[s].pending.empty()) {
        step(v, s);
        ++i;
        continue;
      }
      if (!met) {
        sides[s].exhausted = true;
        ++exhausted;
      }
      active[i] = active.back();
      active.pop_back();
    }
  }
  owner_base += static_cast<std::uint32_t>(sides.size());
  return exhausted + 1;
}

void ChunkSweep::Scratch::seed_sides(std::uint32_t v) {
  sides.clear();
  active.clear();
  side_of.resize(up.count());
  for (std::uint32_t e = 0; e < up.count(); ++e) {
    if (up.group(e) != e) continue;
    side_of[e] = static_cast<std::uint32_t>(sides.size());
    active.push_back(side_of[e]);
    sides.push_back({.parent = side_of[e], .pending = {}, .visited = {}});
  }
  if (owner_base > kNone - sides.size() - 1) {
    std::fill(owner.begin(), owner.end(), 0);
    owner_base = 1;
  }
  for (const std::uint32_t t : stars.middles(v))
    enter(t, side_of[up.group_of_neighbour(stars.hi[t])]);
  for (std::uint32_t t = stars.low_first(v); t < stars.low_last(v); ++t)
    enter(t, side_of[up.group_of_neighbour(stars.hi[t])]);
}

void ChunkSweep::Scratch::enter(std::uint32_t t, std::uint32_t side) {
  owner[t] = owner_base + side;
  sides[side].pending.append(t, next);
}

// Visits one triangle. Of the triangles round a crossing edge only the next in the ring is
// looked at: following the rings from every visited triangle reaches all of them, at a constant
// cost a triangle however many share an edge.
void ChunkSweep::Scratch::step(std::uint32_t v, std::uint32_t s) {
  const std::uint32_t t = sides[s].pending.pop(next);
  sides[s].visited.append(t, next);
  for (const std::uint32_t half : {3 * t + kLoHi, 3 * t + second_crossing(t, v)}) {
    const std::uint32_t beyond = ring[half] / 3;
    const std::uint32_t here = find_side(s);
    if (owner[beyond] < owner_base) {
      enter(beyond, here);
      continue;
    }
    const std::uint32_t there = find_side(owner[beyond] - owner_base);
    if (here == there) continue;
    // Both are active: an exhausted side has no way out to another. The side at hand stays.
    sides[there].parent = here;
    sides[here].pending.splice(sides[there].pending, next);
    sides[here].visited.splice(sides[there].visited, next);
  }
}

}  // namespace reeb
