// Areas and shortest contours of arcs, from the triangles that cross them.
//
// The length of a contour, and the area per unit of the function, are sums over triangles. As functions of the level,
// both are linear between the values of vertices. So the shortest contour is at such a value or tends to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/graph/arc_measures.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/segmentation/arc_chains.h"

namespace reeb {

// The part between two levels of a triangle, where it lies on the arcs of a chain. Length and width of a level grow
// from 0 at `lo` to these at `mid`, and shrink to 0 at `hi`.
struct CrossingTriangle {
  std::uint32_t chain = 0;
  double from = 0, to = 0;  // from < to
  double lo = 0, mid = 0, hi = 0;
  double length = 0;
  double width = 0;  // area per unit of the function

  friend bool operator<(const CrossingTriangle& a, const CrossingTriangle& b) {
    return a.chain < b.chain || (a.chain == b.chain && a.from < b.from);
  }
};

// A sum of linear functions that come and go. What was added is taken away without an error, however steep: sums have
// about 106 bits.
class LinearSum {
 public:
  // Adds slope * (level - origin), or takes it away.
  void add(double slope, double origin);
  void remove(double slope, double origin) { add(-slope, origin); }
  double at(double level) const;

 private:
  struct Sum {
    double high = 0, low = 0;
    void add(double value);
  };
  Sum slope_, offset_;
};

// Takes all triangles, sorted, and adds to the areas of arcs, and sets their shortest contours. NaN: the arc has no
// level between its ends.
//
// TIME:   O(log n) for a triangle, if a contour crosses n.
// MEMORY: 96 bytes for each triangle that the present level crosses.
class ChainMeasures {
 public:
  // REQUIRES: all outlive this.
  ChainMeasures(const ReebGraph& graph, const ArcChains& chains, std::vector<ArcMeasures>& arcs)
      : graph_(graph), chains_(chains), arcs_(arcs) {}

  void add(const CrossingTriangle& triangle);
  void finish();
  std::size_t memory_bytes() const { return changes_.capacity() * sizeof(Change); }

 private:
  // From `level` on, a linear part is added, or is taken away.
  struct Change {
    double level, origin, length_slope, width_slope;
    bool begins;
  };
  static bool later(const Change& a, const Change& b) { return a.level > b.level; }

  void start_chain();
  void end_chain();
  void start_arc();
  void end_arc();
  void add_part(double from, double to, double length, double width, double height, double origin);
  void advance(double level);
  void see(double level);
  void apply(const Change& change);

  const ReebGraph& graph_;
  const ArcChains& chains_;
  std::vector<ArcMeasures>& arcs_;
  std::uint32_t chain_ = 0;
  bool started_ = false;
  std::size_t at_ = 0;   // in the chain
  double top_ = 0;       // of the present arc
  double level_ = 0;     // up to which changes were applied
  double shortest_ = 0;  // of the present arc
  LinearSum length_, width_;
  std::uint64_t open_ = 0;       // parts that were added
  std::vector<Change> changes_;  // that are to come, as a heap
};

}  // namespace reeb
