// The persistence diagram, for gnuplot.
//
// A pair is a point whose coordinates are the values of its nodes. As in extended persistence, the first coordinate is
// where a feature begins: for minima and components (Ord0, Ext0) the lower value, so they lie above the diagonal; for
// maxima and loops (Rel1, Ext1) the upper value, so they lie below it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::io {

// The points of a diagram, as many as a picture can show.
// MEMORY: 16 bytes for each point, at most kCells² of each type, and a bit for each cell.
class DiagramPoints {
 public:
  struct Point {
    double x = 0, y = 0;
  };
  static constexpr std::size_t kMostPoints = 12000;

  // Of `pairs` pairs with values from `low` to `high`. Up to kMostPoints pairs all have a point of their own; of more,
  // points of one type in the same cell are one.
  DiagramPoints(std::uint64_t pairs, double low, double high);

  void add(PairType type, double lo, double hi);
  // Makes cells larger until there are at most kMostPoints points.
  void finish();

  const std::vector<Point>& of(PairType type) const { return points_[static_cast<std::size_t>(type)]; }
  std::uint64_t count(PairType type) const { return counts_[static_cast<std::size_t>(type)]; }
  double low() const { return low_; }
  double high() const { return high_; }
  bool is_thinned() const { return thins_; }

 private:
  static constexpr std::size_t kCells = 1024;  // along an axis

  std::size_t cell(const Point& point, std::size_t cells) const;

  double low_, high_;
  bool thins_;
  std::array<std::vector<Point>, 4> points_{};
  std::array<std::vector<bool>, 4> taken_{};
  std::array<std::uint64_t, 4> counts_{};
};

// Commands for gnuplot. `function` is its name.
std::string diagram_chart(const std::string& function, const DiagramPoints& points);

}  // namespace reeb::io
