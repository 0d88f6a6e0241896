// Shortest contours of arcs, from the triangles that cross them.
//
// The length of a contour is a sum over triangles. As a function of the level, it is linear between the values of
// vertices. So the shortest contour is at such a value or tends to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/graph/arc_measures.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/segmentation/arc_chains.h"

namespace reeb {

// The part between two levels of a triangle, where it lies on the arcs of a chain. The length of a level grows from 0
// at `lo` to `length` at `mid`, and shrinks to 0 at `hi`.
struct CrossingTriangle {
  std::uint32_t chain = 0;
  double from = 0, to = 0;  // from < to
  double lo = 0, mid = 0, hi = 0;
  double length = 0;

  friend bool operator<(const CrossingTriangle& a, const CrossingTriangle& b) {
    return a.chain < b.chain || (a.chain == b.chain && a.from < b.from);
  }
};

// A sum of linear functions that come and go, in about 106 bits.
class LinearSum {
 public:
  // Adds slope * (level - origin), or takes it away.
  void add(double slope, double origin);
  void remove(double slope, double origin) { add(-slope, origin); }
  double at(double level) const;
  // The most by which at() can be wrong because of functions that were taken away. Great only if they were steeper, by
  // many orders of magnitude, than those that are left.
  double error(double level) const;

 private:
  struct Sum {
    double high = 0, low = 0;
    void add(double value);
  };
  Sum slope_, offset_;
  double greatest_slope_ = 0, greatest_offset_ = 0;  // of the sums so far
};

// Takes all triangles, sorted, and sets the shortest contours of arcs. NaN: the arc has no level between its ends.
//
// TIME:   O(log n) for a triangle, if a contour crosses n. O(n) more where LinearSum::error() is great.
// MEMORY: 96 bytes for each triangle that the present level crosses.
class ChainMeasures {
 public:
  // REQUIRES: all outlive this.
  ChainMeasures(const ReebGraph& graph, const ArcChains& chains, std::vector<ArcMeasures>& arcs);

  void add(const CrossingTriangle& triangle);
  void finish();
  std::size_t memory_bytes() const { return changes_.capacity() * sizeof(Change); }

 private:
  // From `level` on, a linear part is added, or is taken away.
  struct Change {
    double level, from, origin, slope;  // `from`: where the part begins
    bool begins;
  };
  static bool later(const Change& a, const Change& b) { return a.level > b.level; }

  // Levels are scaled so that slopes and differences are within the doubles, unless the values have nearly all orders
  // of magnitude that there are.
  double scaled(double value) const { return value * scale_[0] * scale_[1]; }
  double level_of(NodeId node) const { return scaled(graph_.nodes[node.value()].value); }

  void start_chain();
  void end_chain();
  void start_arc();
  void end_arc();
  void add_part(double from, double to, double slope, double origin);
  void advance(double level);
  void see(double level);
  double length_at(double level);
  void apply(const Change& change);

  const ReebGraph& graph_;
  const ArcChains& chains_;
  std::vector<ArcMeasures>& arcs_;
  std::array<double, 2> scale_{1, 1};
  std::uint32_t chain_ = 0;
  bool started_ = false;
  std::size_t at_ = 0;   // in the chain
  double top_ = 0;       // of the present arc
  double level_ = 0;     // up to which changes were applied
  double shortest_ = 0;  // of the present arc
  double longest_ = 0;   // level of a triangle of the chain so far
  LinearSum length_;
  std::uint64_t open_ = 0;       // parts that were added
  std::vector<Change> changes_;  // that are to come, as a heap
};

}  // namespace reeb
