#include "libreeb/defects/defect_lengths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace reeb {
namespace {

// Defects of noise and of merges are at most some 16 edges wide, so about 50 long; features are seen if they are longer
// than that. What is known of where the two meet before any length is: near this many edges, within a factor of 1.6 or
// so.
constexpr double kBorder = 65, kSpread = 0.45;

// The confidence if nothing shows where features begin.
constexpr double kMostUnsure = 0.5;
constexpr const char* kOtherFunctions = "; graphs of other functions may have one";

// How likely the border is below this length.
double chance_below(double edges) { return 0.5 * std::erfc(-std::log(edges / kBorder) / kSpread / std::sqrt(2.0)); }

// "0.123", "45.6": as messages print lengths.
std::string text(double length) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", length);
  return buffer;
}

std::string part_of(std::size_t part, std::size_t all) {
  if (all == 1) return "the only loop is";
  if (part == all) return "all " + std::to_string(all) + " loops are at most";
  return std::to_string(part) + " of " + std::to_string(all) + (part == 1 ? " loops is" : " loops are at most");
}

}  // namespace

SuggestedLength suggest_length(std::span<const double> lengths, double edge, double size, bool looked_well) {
  std::vector<double> sorted(lengths.begin(), lengths.end());
  std::erase_if(sorted, [](double length) { return !(length > 0); });
  std::sort(sorted.begin(), sorted.end());
  if (sorted.empty()) return {std::nullopt, 0, "there are no loops"};
  if (!(edge > 0)) return {std::nullopt, 0, "the mesh has no extent"};
  const double most = std::max(size, edge);
  const auto finite = static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), most) - sorted.begin());
  if (finite == 0 && !looked_well)
    return {std::nullopt, kMostUnsure, "no curve was found" + std::string(kOtherFunctions)};
  if (finite == 0) return {std::nullopt, 0.9, "no loop is short"};
  // Of the gaps between two lengths, the one in which the border is most likely; gap i is below length i.
  const auto from = [&](std::size_t i) { return i == 0 ? 0 : sorted[i - 1]; };
  const auto to = [&](std::size_t i) { return i < finite ? sorted[i] : most; };
  const auto chance = [&](std::size_t i) {
    const double above = i < finite ? chance_below(to(i) / edge) : 1;
    return above - (i == 0 ? 0 : chance_below(from(i) / edge));
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i <= finite; ++i)
    if (chance(i) > chance(best)) best = i;
  if (best == 0)
    return {std::nullopt, chance(0), "no loop is short: the shortest is " + text(sorted[0] / edge) + " edges long"};
  const double low = from(best), high = to(best), ratio = high / low;
  const double length = std::clamp(kBorder * edge, low * std::pow(ratio, 0.3), low * std::pow(ratio, 0.7));
  double confidence = chance(best) * (1 - std::exp(-3 * std::log(ratio)));
  std::string why = part_of(best, sorted.size()) + " " + text(low) + " long (" + text(low / edge) + " edges)";
  if (best < finite) {
    why += ", the others at least " + text(high);
  } else if (best < sorted.size()) {
    const std::size_t others = sorted.size() - best;
    why += "; of the other " + (others == 1 ? "one" : std::to_string(others)) + " no short curve was found";
    if (!looked_well) {
      confidence = std::min(confidence, kMostUnsure);
      why += kOtherFunctions;
    }
  } else {
    confidence = std::min(confidence, kMostUnsure);
    why += "; none is longer, so nothing shows where features begin";
  }
  return {length, confidence, why};
}

}  // namespace reeb
