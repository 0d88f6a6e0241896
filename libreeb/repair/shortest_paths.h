// The shortest paths along the edges of a patch (Dijkstra).
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "libreeb/base/vector3.h"
#include "libreeb/repair/editable_patch.h"

namespace reeb {

// From one vertex, up to a length.
class ShortestPaths {
 public:
  using Vertices = std::vector<std::uint32_t>;

  // Over vertices for which may_enter(vertex). With `to`, only until the path to that one is known.
  template <class MayEnter>
  ShortestPaths(const EditablePatch& patch, std::uint32_t from, double most, const MayEnter& may_enter,
                std::uint32_t to = EditablePatch::kNone)
      : length_(patch.vertex_count(), kFar), before_(patch.vertex_count(), EditablePatch::kNone) {
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    length_[from] = 0;
    queue.emplace(0, from);
    while (!queue.empty()) {
      const auto [so_far, v] = queue.top();
      queue.pop();
      if (so_far > length_[v]) continue;
      reached_.push_back(v);
      if (v == to) return;
      patch.for_each_at(v, [&, at = v, done = so_far](std::uint32_t t) {
        for (const std::uint32_t w : patch.triangle(t).corners) {
          const double next = done + distance(patch.position(at), patch.position(w));
          if (w == at || !may_enter(w) || next > most || next >= length_[w]) continue;
          length_[w] = next;
          before_[w] = at;
          queue.emplace(next, w);
        }
      });
    }
  }

  bool reaches(std::uint32_t v) const { return length_[v] < kFar; }
  double length(std::uint32_t v) const { return length_[v]; }
  const Vertices& reached() const { return reached_; }  // the nearest first
  bool uses(std::uint32_t a, std::uint32_t b) const { return before_[a] == b || before_[b] == a; }

  // With both ends. REQUIRES: reaches(v).
  Vertices path_to(std::uint32_t v) const {
    Vertices path;
    for (; v != EditablePatch::kNone; v = before_[v]) path.push_back(v);
    std::reverse(path.begin(), path.end());
    return path;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  std::vector<double> length_;
  Vertices before_, reached_;
};

}  // namespace reeb
