// Which triangles of a growing list may be near a box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/containers/flat_map.h"
#include "libreeb/graph/settled_node.h"

namespace reeb {

struct PointBox {
  Point low, high;
  static PointBox around(const std::array<Point, 3>& points) {
    PointBox box{points[0], points[0]};
    for (const Point& point : points) box.add({point, point});
    return box;
  }
  void add(const PointBox& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
  bool meets(const PointBox& other) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (high[k] < other.low[k] || other.high[k] < low[k]) return false;
    return true;
  }
  double longest_side() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};

// Each triangle is in the cells that its box touches, or on a list of large ones. MEMORY: about 50 bytes per triangle.
class TriangleCells {
 public:
  // How wide a cell is; before the first add().
  void set_width(double width) { width_ = width > 0 && std::isfinite(width) ? width : 1; }
  std::size_t size() const { return ends_.size(); }
  // The next triangle.
  void add(const PointBox& box) {
    Cells cells{};
    if (!cells_of(box, kMostOfTriangle, cells))
      put(kLarge);
    else
      for_each(cells, [&](std::uint64_t key) { put(key); });
    ends_.push_back(static_cast<std::uint32_t>(entries_.size()));
  }
  // Removes the last ones, down to this number of them.
  void take_back(std::size_t count) {
    if (count >= ends_.size()) return;
    ends_.resize(count);
    const std::size_t end = count == 0 ? 0 : ends_.back();
    for (; entries_.size() > end; entries_.pop_back()) heads_[entries_.back().list] = entries_.back().next;
  }
  // Calls look(triangle) for all triangles whose boxes meet this one, and perhaps for others, some of them repeatedly.
  // Ends when look() returns false.
  template <class Look>
  void visit(const PointBox& box, const Look& look) const {
    Cells cells{};
    if (!cells_of(box, kMostOfQuestion, cells)) {
      for (std::uint32_t t = 0; t < ends_.size(); ++t)
        if (!look(t)) return;
      return;
    }
    bool more = true;
    const auto look_in = [&](std::uint64_t key) {
      const std::uint32_t list = list_of_.find(key);
      if (list == FlatMap::kNone) return;
      for (std::uint32_t i = heads_[list]; more && i != kNone; i = entries_[i].next) more = look(entries_[i].triangle);
    };
    look_in(kLarge);
    for_each(cells, look_in);
  }

 private:
  static constexpr std::uint32_t kNone = FlatMap::kNone;
  static constexpr std::uint64_t kLarge = ~std::uint64_t{0};
  static constexpr double kMostOfTriangle = 64, kMostOfQuestion = 4096;  // cells

  struct Cells {
    std::array<std::int64_t, 3> from, to;
  };
  struct Entry {
    std::uint32_t triangle, next, list;
  };

  // False if there are too many, or too far away.
  bool cells_of(const PointBox& box, double most, Cells& cells) const {
    double count = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double from = std::floor(box.low[k] / width_), to = std::floor(box.high[k] / width_);
      if (!(std::abs(from) < 0x1p50 && std::abs(to) < 0x1p50)) return false;
      count *= to - from + 1;
      cells.from[k] = static_cast<std::int64_t>(from);
      cells.to[k] = static_cast<std::int64_t>(to);
    }
    return count <= most;
  }

  // Cells that are far from each other may share a key; then a question looks at more triangles.
  template <class Visit>
  static void for_each(const Cells& cells, const Visit& visit) {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
    for (std::int64_t z = cells.from[2]; z <= cells.to[2]; ++z)
      for (std::int64_t y = cells.from[1]; y <= cells.to[1]; ++y)
        for (std::int64_t x = cells.from[0]; x <= cells.to[0]; ++x)
          visit((static_cast<std::uint64_t>(x) & kMask) | (static_cast<std::uint64_t>(y) & kMask) << 21 |
                (static_cast<std::uint64_t>(z) & kMask) << 42);
  }

  void put(std::uint64_t key) {
    const auto fresh = static_cast<std::uint32_t>(heads_.size());
    const std::uint32_t list = list_of_.find_or_insert(key, fresh);
    if (list == fresh) heads_.push_back(kNone);
    entries_.push_back({static_cast<std::uint32_t>(ends_.size()), heads_[list], list});
    heads_[list] = static_cast<std::uint32_t>(entries_.size() - 1);
  }

  double width_ = 1;
  FlatMap list_of_;  // of each cell
  std::vector<std::uint32_t> heads_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> ends_;  // of the entries of each triangle
};

}  // namespace reeb
