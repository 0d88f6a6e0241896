// A maximum spanning forest that grows edge by edge, and reports which edge each cycle loses.
//
// Every point except a root has a link, with a weight, to a parent of higher priority. Climbing from x over links of
// weight >= w ends at the point that represents x's component in the forest's edges of weight >= w. Inserting an edge
// climbs from both ends, links the point of lower priority to the other one, and continues with the link that was
// displaced, until it reaches a root or closes a cycle. Only the components at each weight are stored, not the edges of
// the forest: pairing needs no more, and a step costs two array reads where a link-cut tree rotates.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "libreeb/base/prefetch.h"

namespace reeb {

// Priorities are a fixed bijective hash of the points. So the expected depth is O(log n) for every order of insertion
// that was not made to defeat the hash. 8 bytes per point.
class BottleneckForest {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  explicit BottleneckForest(std::uint32_t points) : links_(points) {}

  void prefetch(std::uint32_t x) const { reeb::prefetch(&links_[x]); }

  // Adds the edge (x, y). Returns kNone if it joins two trees, else the least weight on the cycle
  // it closes; that edge leaves the forest.
  std::uint32_t insert(std::uint32_t x, std::uint32_t y, std::uint32_t weight) {
    while (true) {
      x = climb(x, weight);
      y = climb(y, weight);
      if (x == y) return weight;
      if (priority(y) < priority(x)) std::swap(x, y);
      const Link displaced = std::exchange(links_[x], Link{y, weight});
      if (displaced.parent == kNone) return kNone;
      x = y;
      y = displaced.parent;
      weight = displaced.weight;
    }
  }

 private:
  struct Link {
    std::uint32_t parent = kNone;
    std::uint32_t weight = 0;
  };

  static std::uint32_t priority(std::uint32_t x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
  }

  std::uint32_t climb(std::uint32_t x, std::uint32_t weight) {
    while (links_[x].parent != kNone && links_[x].weight >= weight) {
      Link& link = links_[x];
      const Link above = links_[link.parent];
      // The grandparent is in the component of x at the weight of this link too: shorten the path.
      if (above.parent != kNone && above.weight >= link.weight)
        link.parent = above.parent;
      else
        x = link.parent;
    }
    return x;
  }

  std::vector<Link> links_;
};

}  // namespace reeb
