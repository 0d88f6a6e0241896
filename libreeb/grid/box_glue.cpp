#include "libreeb/grid/box_glue.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libreeb/containers/union_find.h"

namespace reeb {
namespace {

// The last axis along which there are several boxes. Every box has a neighbour along it.
std::size_t last_axis(BoxFaces faces) {
  for (std::size_t axis = 2; axis > 0; --axis)
    if ((faces & (low_face(axis) | high_face(axis))) != 0) return axis;
  return 0;
}

// Whether these can be the open nodes and arcs of a fragment: a tree, ascending.
bool is_sound(const Fragment& tree) {
  const std::size_t n = tree.nodes.size();
  if (n == 0 || n >= ContourTree::kNone || tree.positions.size() != n || tree.arcs.size() != n - 1) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Fragment::Node& node = tree.nodes[i];
    if (!std::isfinite(node.key.value) || node.key.vertex.value() + 1 == 0) return false;
    if (i != 0 && !(tree.nodes[i - 1].key < node.key)) return false;
    if ((node.uses & ~tree.shared_faces) != 0 || (node.settled && node.uses != 0)) return false;
  }
  UnionFind united(static_cast<std::uint32_t>(n));
  for (const auto& [lo, hi] : tree.arcs)
    if (lo.value() >= hi.value() || hi.value() >= n || !united.unite(lo.value(), hi.value())) return false;
  return true;
}

bool has_sound_buckets(const Fragment& tree) {
  constexpr int kMostExponent = 2048;  // more than that of any double
  constexpr std::int64_t kMostIndex = std::int64_t{1} << 62;
  constexpr Int128 kMostPerVertex = Int128{1} << 94;
  const auto& begin = tree.bucket_begin;
  if (!tree.options.bucket_exponent) return begin.empty() && tree.buckets.empty();
  const int exponent = *tree.options.bucket_exponent;
  if (exponent > kMostExponent || exponent < -kMostExponent) return false;
  if (begin.size() != tree.arcs.size() + 1 || begin.front() != 0 || begin.back() != tree.buckets.size()) return false;
  if (!std::is_sorted(begin.begin(), begin.end())) return false;
  for (const BucketSum& bucket : tree.buckets) {
    if (bucket.count == 0) return false;
    if (!(bucket.moment >= 0 && bucket.moment < HUGE_VAL)) return false;
    if (bucket.index > kMostIndex || bucket.index < -kMostIndex) return false;
    const Int128 most = kMostPerVertex * static_cast<Int128>(bucket.count);
    for (const Int128 sum : bucket.sum)
      if (sum > most || sum < -most) return false;
  }
  return true;
}

void forget_settled(Fragment& fragment) {
  std::vector<SettledNode>().swap(fragment.settled_nodes);
  std::vector<ArcKeys>().swap(fragment.settled_arcs);
  fragment.settled_lists = {};
}

}  // namespace

// Calls join(i, axis) for each tree that the next box is joined with, one after the other, and says of which run the
// result is. Where a run ends, all of it is joined; along the last axis, every layer is, so that it is one tree.
template <class Join>
void BoxGlue::for_each_join(BoxFaces faces, Tree& tree, const Join& join) const {
  tree.axis = 0;
  tree.boxes = 1;
  for (std::size_t next = trees_.size();;) {
    const bool ends = (faces & high_face(tree.axis)) == 0;
    const bool is_last_axis = tree.axis == last_axis(faces);
    while (next != 0 && trees_[next - 1].axis == tree.axis &&
           (ends || is_last_axis || trees_[next - 1].boxes == tree.boxes)) {
      tree.boxes += trees_[--next].boxes;
      join(next, tree.axis);
    }
    if (!ends || is_last_axis) return;
    ++tree.axis;
    tree.boxes = 1;
  }
}

void BoxGlue::add(const Fragment& fragment) {
  removed_pairs_ += fragment.removed_pairs;
  Tree tree;
  tree.fragment.options = fragment.options;
  tree.fragment.shared_faces = fragment.shared_faces;
  tree.fragment.nodes = fragment.nodes;
  tree.fragment.positions = fragment.positions;
  tree.fragment.arcs = fragment.arcs;
  copy_buckets(fragment, tree.fragment);
  note_nodes(fragment);
  fragment.pass_settled_to(*sink_);
  for_each_join(fragment.shared_faces, tree, [&](std::size_t i, std::size_t axis) {
    union_.run(trees_[i].fragment, tree.fragment, axis, fragment.options, result_);
    trees_.resize(i);
    removed_pairs_ += result_.removed_pairs;
    result_.pass_settled_to(*sink_);
    std::swap(tree.fragment, result_);
    forget_settled(tree.fragment);
  });
  result_ = {};
  if (tree.fragment.shared_faces != 0) trees_.push_back(std::move(tree));
}

// With the vertices that are passed. One that is a node in no box is regular: it is on the arc that passes it in the
// last box that has it. They come in ascending order.
void BoxGlue::copy_buckets(const Fragment& fragment, Fragment& tree) {
  if (!fragment.options.bucket_exponent) return;
  const BucketIndexer index_of(*fragment.options.bucket_exponent);
  first_passed_.assign(fragment.arcs.size(), FlatMap::kNone);
  next_passed_.resize(fragment.passed.size());
  for (auto p = static_cast<std::uint32_t>(fragment.passed.size()); p-- > 0;)
    if (nodes_ahead_.find(fragment.passed[p].vertex.value()) == FlatMap::kNone)
      next_passed_[p] = std::exchange(first_passed_[fragment.passed[p].arc.value()], p);
  tree.bucket_begin.push_back(0);
  for (std::size_t a = 0; a < fragment.arcs.size(); ++a) {
    std::uint32_t at = fragment.bucket_begin[a];
    const auto copy_up_to = [&](std::int64_t index) {
      for (; at < fragment.bucket_begin[a + 1] && fragment.buckets[at].index <= index; ++at)
        tree.buckets.push_back(fragment.buckets[at]);
    };
    for (std::uint32_t p = first_passed_[a]; p != FlatMap::kNone; p = next_passed_[p]) {
      const std::int64_t index = index_of(fragment.passed[p].value);
      copy_up_to(index);
      if (tree.buckets.size() == tree.bucket_begin.back() || tree.buckets.back().index != index)
        tree.buckets.push_back({.index = index});
      tree.buckets.back().add(fragment.passed[p].position);
    }
    copy_up_to(std::numeric_limits<std::int64_t>::max());
    tree.bucket_begin.push_back(static_cast<std::uint32_t>(tree.buckets.size()));
  }
}

void BoxGlue::note_nodes(const Fragment& fragment) {
  for (const Fragment::Node& node : fragment.nodes) {
    if ((node.uses & kHighFaces) != 0)
      nodes_ahead_.find_or_insert(node.key.vertex.value(), 0);
    else if (node.uses != 0)
      nodes_ahead_.erase(node.key.vertex.value());
  }
  for (const Fragment::Passed& passed : fragment.passed) nodes_ahead_.erase(passed.vertex.value());
}

std::size_t BoxGlue::live_arcs() const {
  std::size_t arcs = 0;
  for (const Tree& tree : trees_) arcs += tree.fragment.arcs.size();
  return arcs;
}

std::uint64_t BoxGlue::vertex_bound() const {
  std::uint64_t bound = 0;
  for (const Tree& tree : trees_)
    for (const Fragment::Node& node : tree.fragment.nodes) bound = std::max(bound, node.key.vertex.value() + 1);
  return bound;
}

std::size_t BoxGlue::memory_bytes() const {
  std::size_t bytes = nodes_ahead_.memory_bytes() + union_.memory_bytes() + trees_.capacity() * sizeof(Tree) +
                      4 * (first_passed_.capacity() + next_passed_.capacity());
  for (const Tree& tree : trees_) bytes += tree.fragment.memory_bytes();
  return bytes;
}

// Next to two trees there is their union, before these are freed.
std::size_t BoxGlue::memory_bytes_with(const Fragment& fragment) const {
  std::size_t nodes = fragment.nodes.size(), bytes = 2 * fragment.memory_bytes();
  Tree tree;
  for_each_join(fragment.shared_faces, tree, [&](std::size_t i, std::size_t) {
    nodes += trees_[i].fragment.nodes.size();
    bytes += trees_[i].fragment.memory_bytes();
  });
  const std::size_t scratch = BoxUnion::kBytesPerNode * nodes;
  return memory_bytes() + bytes + scratch - std::min(scratch, union_.memory_bytes());
}

// ---- saving and restoring, between two layers; the nodes ahead are rebuilt from the tree

void BoxGlue::save(StateWriter& out) const {
  out.put(removed_pairs_);
  out.put(std::uint64_t{trees_.size()});
  if (trees_.empty()) return;
  const Fragment& tree = trees_.front().fragment;
  out.put(tree.shared_faces);
  out.put(tree.options.bucket_exponent.has_value());
  out.put(tree.options.bucket_exponent.value_or(0));
  out.put_array(tree.nodes);
  out.put_array(tree.positions);
  out.put_array(tree.arcs);
  out.put_array(tree.bucket_begin);
  out.put_array(tree.buckets);
}

void BoxGlue::restore(StateReader& in) {
  in.get(removed_pairs_);
  const auto count = in.get<std::uint64_t>();
  trees_.clear();
  nodes_ahead_.clear();
  if (count == 0) return;
  if (count > 1) throw DamagedState();
  Tree& tree = trees_.emplace_back();
  Fragment& fragment = tree.fragment;
  in.get(fragment.shared_faces);
  const bool embeds = in.get_bool();
  if (const int exponent = in.get<int>(); embeds) fragment.options.bucket_exponent = exponent;
  in.get_array(fragment.nodes);
  in.get_array(fragment.positions);
  in.get_array(fragment.arcs);
  in.get_array(fragment.bucket_begin);
  in.get_array(fragment.buckets);
  if (!is_sound(fragment) || !has_sound_buckets(fragment)) throw DamagedState();
  tree.axis = last_axis(fragment.shared_faces);
  note_nodes(fragment);
}

}  // namespace reeb
