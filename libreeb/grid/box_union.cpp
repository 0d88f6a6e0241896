#include "libreeb/grid/box_union.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "libreeb/base/state_stream.h"

namespace reeb {

void BoxUnion::run(const Fragment& before, const Fragment& after, std::size_t axis, const SweepOptions& options,
                   Fragment& result) {
  merge_nodes(before, after, axis);
  arcs_.clear();
  add_arcs(before, ranks_[0]);
  add_arcs(after, ranks_[1]);
  tree_.build(static_cast<std::uint32_t>(values_.size()), arcs_);
  const SweptChunk swept{chunk_, values_, order_, nullptr};
  sweep_.run(swept, tree_, keep_, options);
  if (options.bucket_exponent) {
    place_vertices();
    move_buckets(before, ranks_[0], *options.bucket_exponent);
    move_buckets(after, ranks_[1], *options.bucket_exponent);
  }
  sweep_.finish(swept, result);
}

// ---- the two trees as one graph

// Both have their nodes in ascending order.
void BoxUnion::merge_nodes(const Fragment& before, const Fragment& after, std::size_t axis) {
  const BoxFaces high = high_face(axis), low = low_face(axis);
  chunk_.clear();
  chunk_.shared_faces = static_cast<BoxFaces>((before.shared_faces & ~high) | (after.shared_faces & ~low));
  values_.clear();
  keep_.clear();
  ranks_[0].clear();
  ranks_[1].clear();
  const auto &a = before.nodes, &b = after.nodes;
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    const bool of_a = j == b.size() || (i < a.size() && !(b[j].key < a[i].key));
    const bool of_b = i == a.size() || (j < b.size() && !(a[i].key < b[j].key));
    const auto rank = static_cast<std::uint32_t>(values_.size());
    if (of_a)
      add_node(before, i, high);
    else
      add_node(after, j, low);
    if (of_a && of_b) {
      chunk_.uses.back() |= static_cast<BoxFaces>(b[j].uses & ~low);
      if (b[j].settled) keep_.back() = TreeSweep::kWithLostArcs;
    }
    if (of_a) ranks_[0].push_back(rank), ++i;
    if (of_b) ranks_[1].push_back(rank), ++j;
    if (chunk_.uses.back() != 0 && keep_.back() == TreeSweep::kIfNotRegular) keep_.back() = TreeSweep::kAlways;
  }
  for (auto n = static_cast<std::uint32_t>(order_.size()); n < values_.size(); ++n) order_.push_back(n);
  order_.resize(values_.size());
}

void BoxUnion::add_node(const Fragment& fragment, std::size_t i, BoxFaces no_longer_shared) {
  const Fragment::Node& node = fragment.nodes[i];
  values_.push_back(node.key.value);
  chunk_.ids.push_back(node.key.vertex);
  chunk_.uses.push_back(static_cast<BoxFaces>(node.uses & ~no_longer_shared));
  if (!fragment.positions.empty()) chunk_.positions.push_back(fragment.positions[i]);
  keep_.push_back(node.settled ? TreeSweep::kWithLostArcs : TreeSweep::kIfNotRegular);
}

void BoxUnion::add_arcs(const Fragment& fragment, const std::vector<std::uint32_t>& ranks) {
  for (const Fragment::Arc& arc : fragment.arcs) arcs_.push_back({ranks[arc.lo.value()], ranks[arc.hi.value()]});
}

// ---- the embedding: each arc is now a path, and its vertices go to the arcs of that path

void BoxUnion::place_vertices() {
  places_.resize(values_.size());
  const std::uint32_t root = tree_.from_root()[0];
  places_[root] = {0, root};
  for (const std::uint32_t v : tree_.from_root().subspan(1)) {
    const std::uint32_t parent = tree_.parent(v);
    const Place& above = places_[parent];
    const Place& beyond = places_[above.jump];
    const bool two_equal_jumps = above.depth - beyond.depth == beyond.depth - places_[beyond.jump].depth;
    places_[v] = {above.depth + 1, two_equal_jumps ? beyond.jump : parent};
  }
}

// The farthest ancestor that v can reach through ancestors u with may(u).
// REQUIRES: if may() holds for an ancestor, it holds for those before it.
template <class May>
std::uint32_t BoxUnion::climb(std::uint32_t v, const May& may) const {
  for (;;) {
    if (const std::uint32_t jump = places_[v].jump; jump != v && may(jump))
      v = jump;
    else if (const std::uint32_t parent = tree_.parent(v); parent != ContourTree::kNone && may(parent))
      v = parent;
    else
      return v;
  }
}

BoxUnion::Path BoxUnion::path_between(std::uint32_t lo, std::uint32_t hi) const {
  if (tree_.parent(lo) == hi) return {lo, hi, hi};
  if (tree_.parent(hi) == lo) return {lo, hi, lo};
  const auto climb_to = [&](std::uint32_t v, std::uint32_t depth) {
    return climb(v, [&](std::uint32_t u) { return places_[u].depth >= depth; });
  };
  std::uint32_t a = climb_to(lo, places_[hi].depth), b = climb_to(hi, places_[lo].depth);
  while (a != b) {
    const bool jump = places_[a].jump != places_[b].jump;
    a = jump ? places_[a].jump : tree_.parent(a);
    b = jump ? places_[b].jump : tree_.parent(b);
  }
  return {lo, hi, a};
}

SweepArc BoxUnion::arc_at(const Path& path, double value) const {
  const bool below_top = path.lo != path.top && (value < values_[path.top] || path.hi == path.top);
  const std::uint32_t depth = places_[path.top].depth;
  if (below_top)
    return sweep_.arc_of(
        climb(path.lo, [&](std::uint32_t u) { return places_[u].depth > depth && values_[u] <= value; }));
  return sweep_.arc_of(climb(path.hi, [&](std::uint32_t u) { return places_[u].depth > depth && values_[u] > value; }));
}

void BoxUnion::move_buckets(const Fragment& fragment, const std::vector<std::uint32_t>& ranks, int exponent) {
  if (!fragment.options.bucket_exponent) return;
  if (exponent < *fragment.options.bucket_exponent) throw DamagedState();  // only a restored fragment can be coarser
  const int levels = std::min(exponent - *fragment.options.bucket_exponent, 63);
  for (std::size_t i = 0; i < fragment.arcs.size(); ++i) {
    const auto [begin, end] = std::array{fragment.bucket_begin[i], fragment.bucket_begin[i + 1]};
    if (begin == end) continue;
    const Path path = path_between(ranks[fragment.arcs[i].lo.value()], ranks[fragment.arcs[i].hi.value()]);
    for (BucketSum bucket : std::span(fragment.buckets).subspan(begin, end - begin)) {
      bucket.index >>= levels;
      move_bucket(path, bucket, exponent);
    }
  }
}

// A bucket through which several arcs of the path pass is divided in proportion to the value. With few vertices, or
// many arcs, it goes whole to the arc in the middle of its values. Works on halved values, so that no difference
// overflows.
void BoxUnion::move_bucket(const Path& path, BucketSum bucket, int exponent) {
  constexpr std::uint64_t kBucketDividesFrom = 4;  // vertices
  constexpr std::size_t kMostArcs = 16;
  const double least = std::max(std::ldexp(static_cast<double>(bucket.index), exponent), values_[path.lo]);
  const double most = std::min(std::ldexp(static_cast<double>(bucket.index + 1), exponent), values_[path.hi]);
  SweepArc arc = arc_at(path, least);
  const SweepArc last = arc_at(path, most);
  if (arc == last) return sweep_.add_bucket(arc, bucket);

  const SweepGraph& graph = sweep_.graph();
  std::array<SweepArc, kMostArcs> passed;
  std::array<double, kMostArcs> ends;
  std::size_t count = 0;
  if (bucket.count >= kBucketDividesFrom)
    for (; arc != last && count < kMostArcs; arc = arc_at(path, ends[count - 1])) {
      passed[count] = arc;
      ends[count++] = values_[graph.nodes[graph.arcs[arc].hi].vertex.value()];
    }
  if (arc != last) return sweep_.add_bucket(arc_at(path, least / 2 + most / 2), bucket);
  double begin = least;
  for (std::size_t i = 0; i < count; ++i) {
    const double whole = most / 2 - begin / 2, part = ends[i] / 2 - begin / 2;
    const double share = whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.5;
    const auto kept = static_cast<std::uint64_t>(std::nearbyint(share * static_cast<double>(bucket.count)));
    begin = ends[i];
    if (kept == 0) continue;
    if (kept >= bucket.count) return sweep_.add_bucket(passed[i], bucket);
    BucketSum rest{.index = bucket.index};
    bucket.keep(kept, rest);
    sweep_.add_bucket(passed[i], bucket);
    bucket = rest;
  }
  sweep_.add_bucket(last, bucket);
}

std::size_t BoxUnion::memory_bytes() const {
  return tree_.memory_bytes() + sweep_.memory_bytes() + chunk_.ids.capacity() * sizeof(VertexId) +
         chunk_.uses.capacity() + chunk_.positions.capacity() * sizeof(Point) + 8 * values_.capacity() +
         keep_.capacity() + arcs_.capacity() * sizeof(ContourTree::Arc) + places_.capacity() * sizeof(Place) +
         4 * (order_.capacity() + ranks_[0].capacity() + ranks_[1].capacity());
}

}  // namespace reeb
