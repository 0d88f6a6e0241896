// Which lengths are those of noise: the gap between small and large ones.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace reeb {

struct SuggestedLength {
  std::optional<double> length;  // curves that are shorter are likely defects; none: no such length is known
  double confidence = 0;         // 0 to 1
  std::string why;
};

// `lengths`: of the curves of loops, in any order, infinite ones among them; `edge`: the typical length of an edge;
// `size`: of the whole mesh, and no defect is so long. The length is in the gap in which the border between noise and
// features is most likely, which is near 65 edges before any length is known. If there is nothing longer to compare
// with, the confidence is at most 0.5. Infinite lengths are something longer only if `looked_well`: too few functions
// have short curves of too few loops.
SuggestedLength suggest_length(std::span<const double> lengths, double edge, double size, bool looked_well = true);

}  // namespace reeb
