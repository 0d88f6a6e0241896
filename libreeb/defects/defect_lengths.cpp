#include "libreeb/defects/defect_lengths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace reeb {
namespace {

// A defect of noise or of a merge spans a few dozen edges.
constexpr double kMostEdges = 72;
// A ratio of two neighbouring lengths that chance does not explain.
constexpr double kLeastGap = 1.3;

// "0.123", "45.6": as messages print lengths.
std::string text(double length) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", length);
  return buffer;
}

}  // namespace

SuggestedLength suggest_length(std::span<const double> lengths, double edge, double size) {
  std::vector<double> sorted(lengths.begin(), lengths.end());
  std::erase_if(sorted, [](double length) { return !(length > 0); });
  std::sort(sorted.begin(), sorted.end());
  if (sorted.empty()) return {std::nullopt, 0, "there are no loops"};
  const auto finite =
      static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), std::max(size, edge)) - sorted.begin());
  if (finite == 0) return {std::nullopt, 0.5, "no loop is short"};
  // The gap above the last length is the one to the size of the mesh: nothing is known to be longer.
  const auto above = [&](std::size_t i) { return i + 1 < finite ? sorted[i + 1] : std::max(size, edge); };
  std::optional<std::size_t> best;
  double best_score = 0;
  for (std::size_t i = 0; i < finite && sorted[i] <= kMostEdges * edge; ++i) {
    const double gap = std::log(above(i) / sorted[i]);
    if (gap < std::log(kLeastGap)) continue;
    // A gap among the shortest lengths says less than one of the same width above all that noise can be.
    const double score = gap * std::sqrt(std::min(1.0, above(i) / (kMostEdges * edge)));
    if (score > best_score) {
      best_score = score;
      best = i;
    }
  }
  if (!best) {
    const auto short_ones =
        static_cast<std::size_t>(std::upper_bound(sorted.begin(), sorted.end(), kMostEdges * edge) - sorted.begin());
    if (short_ones == 0) return {std::nullopt, 0.7, "all loops are longer than noise is: more than 72 edges"};
    return {kMostEdges * edge, 0.2,
            "no gap divides the lengths; " + std::to_string(short_ones) + " of " + std::to_string(sorted.size()) +
                " loops are at most 72 edges long"};
  }
  const double from = sorted[*best], to = above(*best);
  const double confidence = 1 - std::exp(-1.6 * std::log(to / from) * std::min(1.0, to / (kMostEdges * edge)));
  const std::string below = std::to_string(*best + 1) + " of " + std::to_string(sorted.size()) + " loops are at most " +
                            text(from) + " long, ";
  return {std::sqrt(from * to), confidence,
          below + (*best + 1 < finite          ? "the others at least " + text(to)
                   : *best + 1 < sorted.size() ? "the others longer than the mesh is wide (" + text(to) + ')'
                                               : "far less than the mesh is wide (" + text(to) + ')')};
}

}  // namespace reeb
