#include "libreeb/grid/contour_tree.h"

#include <bit>
#include <utility>

#include "libreeb/base/state_stream.h"
#include "libreeb/grid/neighbour_groups.h"

namespace reeb {

void ContourTree::build(const BoxSize& size, std::span<const std::uint32_t> order) {
  count_ = static_cast<std::uint32_t>(order.size());
  place(size, order);
  find_groups();
  for (const bool up : {true, false})
    sweep(up, [this, up](std::uint32_t v, const auto& visit) {
      const std::uint32_t* const here = padded_rank_.data() + place_[v];
      for (unsigned set = groups_[v][up ? 0 : 1]; set != 0; set &= set - 1)
        visit(here[offsets_[static_cast<std::size_t>(std::countr_zero(set))]]);
    });
  merge();
}

void ContourTree::build(std::uint32_t count, std::span<const Arc> arcs) {
  count_ = count;
  for (const bool up : {true, false}) {
    list_neighbours(arcs, up);
    sweep(up, [this](std::uint32_t v, const auto& visit) {
      for (std::uint32_t i = begin_[v]; i < begin_[v + 1]; ++i) visit(neighbours_[i]);
    });
  }
  merge();
}

// By counting: those below each vertex, or those above.
void ContourTree::list_neighbours(std::span<const Arc> arcs, bool below) {
  begin_.assign(count_ + 2, 0);
  neighbours_.resize(arcs.size());
  for (const Arc& arc : arcs) ++begin_[(below ? arc.hi : arc.lo) + 2];
  for (std::uint32_t v = 0; v < count_; ++v) begin_[v + 2] += begin_[v + 1];
  for (const Arc& arc : arcs) neighbours_[begin_[(below ? arc.hi : arc.lo) + 1]++] = below ? arc.lo : arc.hi;
}

void ContourTree::place(const BoxSize& size, std::span<const std::uint32_t> order) {
  size_ = size;
  const std::uint32_t row = size[0] + 2, slice = row * (size[1] + 2);
  for (unsigned n = 0; n < kNeighbours; ++n) {
    const auto step = step_to(n);
    offsets_[n] = step[0] + step[1] * static_cast<std::int32_t>(row) + step[2] * static_cast<std::int32_t>(slice);
  }
  padded_rank_.assign(std::size_t{slice} * (size[2] + 2), kNone);
  place_.resize(count_);
  const std::uint32_t first = 1 + row + slice, plane = size[0] * size[1];
  for (std::uint32_t r = 0; r < count_; ++r) {
    const std::uint32_t k = order[r] / plane, in_plane = order[r] % plane, j = in_plane / size[0];
    place_[r] = first + in_plane - j * size[0] + j * row + k * slice;
    padded_rank_[place_[r]] = r;
  }
}

// In the order of memory.
void ContourTree::find_groups() {
  const NeighbourSet* const groups = groups_of_sets().data();
  groups_.resize(count_);
  const std::uint32_t* const ranks = padded_rank_.data();
  for (std::size_t p = 0; p < padded_rank_.size(); ++p) {
    const std::uint32_t r = ranks[p];
    if (r == kNone) continue;
    unsigned below = 0, there = 0;
    for (unsigned n = 0; n < kNeighbours; ++n) {
      const std::uint32_t other = ranks[static_cast<std::ptrdiff_t>(p) + offsets_[n]];
      below |= static_cast<unsigned>(other < r) << n;
      there |= static_cast<unsigned>(other != kNone) << n;
    }
    groups_[r] = {groups[below], groups[there & ~below]};
  }
}

std::uint32_t ContourTree::find(std::uint32_t v) {
  while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
  return v;
}

// Upward for the join tree, downward for the split tree. The representative of a component is the last vertex so far.
template <class ForEachBefore>
void ContourTree::sweep(bool up, const ForEachBefore& for_each_before) {
  std::vector<Link>& links = up ? join_ : split_;
  links.resize(count_);
  parent_.resize(count_);
  for (std::uint32_t i = 0; i < count_; ++i) {
    const std::uint32_t v = up ? i : count_ - 1 - i;
    parent_[v] = v;
    links[v] = {kNone, 0, 0};
    for_each_before(v, [&](std::uint32_t neighbour) {
      const std::uint32_t last = find(neighbour);
      if (last == v) return;
      parent_[last] = v;
      links[last].onward = v;
      links[v].others ^= last;
      ++links[v].count;
    });
  }
}

bool ContourTree::is_extremum_within(std::uint32_t place, unsigned neighbours) const {
  const std::uint32_t* const here = padded_rank_.data() + place;
  bool above = true, below = true;
  for (; neighbours != 0 && (above || below); neighbours &= neighbours - 1) {
    const std::uint32_t other = here[offsets_[static_cast<std::size_t>(std::countr_zero(neighbours))]];
    if (other == kNone) continue;
    (other < *here ? below : above) = false;
  }
  return above || below;
}

// A vertex that is a leaf of one tree and passes through the other is a leaf of the contour tree. It is taken out of
// both until one vertex is left. If none is a leaf, there is no tree.
void ContourTree::merge() {
  nodes_.assign(count_, {});
  edges_.resize(count_);
  leaves_.clear();
  const auto is_leaf = [this](std::uint32_t v) { return join_[v].count + split_[v].count == 1; };
  for (std::uint32_t v = 0; v < count_; ++v)
    if (is_leaf(v)) leaves_.push_back(v);
  from_root_.resize(count_);
  for (std::uint32_t left = count_; left > 1; --left) {
    if (leaves_.empty() || !is_leaf(leaves_.back())) throw DamagedState();
    const std::uint32_t v = from_root_[left - 1] = leaves_.back();
    leaves_.pop_back();
    const bool upper = split_[v].count == 0;
    const std::uint32_t other = upper ? split_[v].onward : join_[v].onward;
    if (other == kNone) throw DamagedState();
    parent_[v] = other;
    if (upper) {
      remove_leaf(split_, join_, v);
      add_edge(v, other, v);
    } else {
      remove_leaf(join_, split_, v);
      add_edge(v, v, other);
    }
    if (is_leaf(other)) leaves_.push_back(other);
    from_root_[0] = other;
  }
  if (count_ == 1) from_root_[0] = 0;
  parent_[from_root_[0]] = kNone;
}

// Takes a leaf of `own` out of both trees.
void ContourTree::remove_leaf(std::vector<Link>& own, std::vector<Link>& other, std::uint32_t v) {
  Link& at = own[own[v].onward];
  at.others ^= v;
  --at.count;
  const std::uint32_t before = other[v].others, after = other[v].onward;
  other[before].onward = after;
  if (after != kNone) other[after].others ^= v ^ before;
}

void ContourTree::add_edge(std::uint32_t e, std::uint32_t lo, std::uint32_t hi) {
  edges_[e].next = {std::exchange(nodes_[hi].first[0], e), std::exchange(nodes_[lo].first[1], e)};
  ++nodes_[hi].degree[0];
  ++nodes_[lo].degree[1];
}

std::size_t ContourTree::memory_bytes() const {
  return 4 * (padded_rank_.capacity() + place_.capacity() + groups_.capacity() + parent_.capacity() +
              leaves_.capacity() + begin_.capacity() + neighbours_.capacity() + from_root_.capacity()) +
         (join_.capacity() + split_.capacity()) * sizeof(Link) + nodes_.capacity() * sizeof(Node) +
         edges_.capacity() * sizeof(Edge);
}

}  // namespace reeb
