// The number of loops above a persistence, for gnuplot: Figure 9 of the paper.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace reeb::io {

struct LoopSeries {
  std::string name;
  std::vector<double> percents;  // of the range of the function, above 0, ascending
};

// The corners of its steps, from left to right: at least `second` loops have a persistence up to `first`. Exactly one
// corner for each loop if there are at most kMostCorners; else those that a picture can show.
inline constexpr std::size_t kMostCorners = 1000;
std::vector<std::pair<double, std::size_t>> loop_steps(std::span<const double> percents);

// Commands for gnuplot. REQUIRES: a loop in any of the series.
std::string loop_chart(std::span<const LoopSeries> series);

}  // namespace reeb::io
