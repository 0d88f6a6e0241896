#include "io/plot/branch_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/plot/specks.h"

namespace reeb::io {
namespace {

// A spanning forest: nodes in an order in which each comes after its parent (itself at a root).
struct Forest {
  std::vector<std::uint32_t> order, parent;
};

Forest spanning_forest(const ReebGraph& graph, const Neighbors& neighbors) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  Forest forest;
  forest.parent.assign(graph.node_count(), kNone);
  forest.order.reserve(graph.node_count());
  for (std::uint32_t root = 0; root < graph.node_count(); ++root) {
    if (forest.parent[root] != kNone) continue;
    forest.parent[root] = root;
    // Breadth first: the two sides of a loop grow alike.
    std::size_t next = forest.order.size();
    forest.order.push_back(root);
    for (; next < forest.order.size(); ++next) {
      const std::uint32_t node = forest.order[next];
      for (std::size_t i = neighbors.offsets[node]; i < neighbors.offsets[node + 1]; ++i) {
        const std::uint32_t other = neighbors.neighbors[i];
        if (forest.parent[other] != kNone) continue;
        forest.parent[other] = node;
        forest.order.push_back(other);
      }
    }
  }
  return forest;
}

// The room that something takes, row by row: from left[i] to right[i] in row `first` + i.
struct Outline {
  std::size_t first = 0;
  std::vector<float> left, right;

  std::size_t last() const { return first + left.size() - 1; }
  // Makes it reach these rows; new ones are empty.
  void cover(std::size_t from, std::size_t to) {
    constexpr float kFar = 1e30F;
    if (left.empty()) first = from;
    if (from < first) {
      left.insert(left.begin(), first - from, kFar);
      right.insert(right.begin(), first - from, -kFar);
      first = from;
    }
    if (to >= first + left.size()) {
      left.resize(to + 1 - first, kFar);
      right.resize(to + 1 - first, -kFar);
    }
  }
  void take(const Outline& other, float shift) {
    cover(other.first, other.last());
    for (std::size_t i = 0; i < other.left.size(); ++i) {
      float& l = left[other.first + i - first];
      float& r = right[other.first + i - first];
      l = std::min(l, other.left[i] + shift);
      r = std::max(r, other.right[i] + shift);
    }
  }
  // How far `other` has to move to the right (or left) of this to be at a distance of 1 in all rows.
  float shift_to_the_right(const Outline& other) const {
    float shift = 0;
    for (std::size_t row = std::max(first, other.first); row <= std::min(last(), other.last()); ++row)
      shift = std::max(shift, right[row - first] + 1 - other.left[row - other.first]);
    return shift;
  }
  float shift_to_the_left(const Outline& other) const {
    float shift = 0;
    for (std::size_t row = std::max(first, other.first); row <= std::min(last(), other.last()); ++row)
      shift = std::min(shift, left[row - first] - 1 - other.right[row - other.first]);
    return shift;
  }
};

class BranchPlaces {
 public:
  BranchPlaces(const Forest& forest, std::span<const double> height, std::span<const std::uint32_t> specks)
      : forest_(forest), height_(height) {
    const std::size_t count = forest.order.size();
    reach_.assign(height.begin(), height.end());
    next_.assign(count, kNone);
    for (std::size_t i = count; i-- > 0;) {
      const std::uint32_t node = forest.order[i], parent = forest.parent[node];
      if (parent == node) continue;
      const double start = height_[parent];
      if (next_[parent] == kNone || std::abs(reach_[node] - start) > std::abs(reach_[parent] - start)) {
        next_[parent] = node;
        reach_[parent] = reach_[node];
      }
    }
    shift_.assign(count, 0);
    std::vector<Outline> outlines(count);                     // of finished branches, at their first nodes
    std::vector<std::vector<std::uint32_t>> branches(count);  // at their parents' first nodes
    Outline all;
    for (std::size_t i = count; i-- > 0;) {
      const std::uint32_t node = forest.order[i], parent = forest.parent[node];
      if (parent != node && next_[parent] == node) continue;
      outlines[node] = place_branch(node, branches[node], outlines);
      if (parent != node) branches[first_of(parent)].push_back(node);
    }
    bool any = false;
    for (const std::uint32_t root : roots_by_size()) {
      if (specks[root] != kNoSpeck) continue;
      shift_[root] = any ? all.shift_to_the_right(outlines[root]) : 0;
      all.take(outlines[root], shift_[root]);
      any = true;
    }
  }

  std::vector<double> places() const {
    std::vector<double> result(forest_.order.size());
    for (const std::uint32_t node : forest_.order) {
      const std::uint32_t parent = forest_.parent[node];
      result[node] = (parent == node ? 0 : result[parent]) + shift_[node];
    }
    return result;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr double kOutlineRows = 160;

  static std::size_t outline_row(double height) { return static_cast<std::size_t>(height * kOutlineRows); }

  // Of the largest component first.
  std::vector<std::uint32_t> roots_by_size() const {
    std::vector<std::uint32_t> roots, size(forest_.order.size(), 0);
    for (std::size_t i = forest_.order.size(); i-- > 0;) {
      const std::uint32_t node = forest_.order[i], parent = forest_.parent[node];
      ++size[node];
      if (parent != node) size[parent] += size[node];
    }
    for (const std::uint32_t node : forest_.order)
      if (forest_.parent[node] == node) roots.push_back(node);
    std::stable_sort(roots.begin(), roots.end(), [&](std::uint32_t a, std::uint32_t b) { return size[a] > size[b]; });
    return roots;
  }

  // The first node of the branch of `node`.
  std::uint32_t first_of(std::uint32_t node) {
    if (first_.empty()) {
      first_.resize(forest_.order.size());
      for (const std::uint32_t at : forest_.order) {
        const std::uint32_t parent = forest_.parent[at];
        first_[at] = parent != at && next_[parent] == at ? first_[parent] : at;
      }
    }
    return first_[node];
  }

  Outline place_branch(std::uint32_t first, std::vector<std::uint32_t>& branches, std::vector<Outline>& outlines) {
    Outline outline;
    for (std::uint32_t node = first; node != kNone; node = next_[node]) {
      const std::size_t here = outline_row(height_[node]);
      const std::uint32_t parent = forest_.parent[node];
      const std::size_t there = node == first ? here : outline_row(height_[parent]);
      Outline step;
      step.cover(std::min(here, there), std::max(here, there));
      std::fill(step.left.begin(), step.left.end(), 0.0F);
      std::fill(step.right.begin(), step.right.end(), 0.0F);
      outline.take(step, 0);
    }
    std::sort(branches.begin(), branches.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(outlines[a].left.size(), a) < std::pair(outlines[b].left.size(), b);
    });
    for (const std::uint32_t branch : branches) {
      const float right = outline.shift_to_the_right(outlines[branch]);
      const float left = outline.shift_to_the_left(outlines[branch]);
      // At least beside its own fork.
      shift_[branch] = -left < right ? std::min(left, -1.0F) : std::max(right, 1.0F);
      outline.take(outlines[branch], shift_[branch]);
      outlines[branch] = {};
    }
    return outline;
  }

  const Forest& forest_;
  const std::span<const double> height_;
  std::vector<double> reach_;        // the height to which the branch from here gets
  std::vector<std::uint32_t> next_;  // on the branch
  std::vector<std::uint32_t> first_;
  std::vector<float> shift_;  // from the parent
};

}  // namespace

Neighbors neighbors_of(const ReebGraph& graph) {
  Neighbors result;
  result.offsets.assign(graph.node_count() + 1, 0);
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    ++result.offsets[graph.lo[arc].value() + 1];
    ++result.offsets[graph.hi[arc].value() + 1];
  }
  for (std::size_t i = 1; i < result.offsets.size(); ++i) result.offsets[i] += result.offsets[i - 1];
  result.neighbors.resize(2 * graph.arc_count());
  std::vector<std::size_t> next(result.offsets.begin(), result.offsets.end() - 1);
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const auto lo = static_cast<std::uint32_t>(graph.lo[arc].value());
    const auto hi = static_cast<std::uint32_t>(graph.hi[arc].value());
    result.neighbors[next[lo]++] = hi;
    result.neighbors[next[hi]++] = lo;
  }
  return result;
}

std::vector<double> branch_places(const ReebGraph& graph, std::span<const double> height,
                                  std::span<const std::uint32_t> specks) {
  const Forest forest = spanning_forest(graph, neighbors_of(graph));
  return BranchPlaces(forest, height, specks).places();
}

}  // namespace reeb::io
