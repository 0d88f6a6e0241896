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
// `size`: of the whole mesh. Looks for gaps in the lengths on a logarithmic axis; what is as long as the mesh is large
// is no defect. Of gaps that are wide enough, the highest one counts above which nothing is as short as noise can be.
SuggestedLength suggest_length(std::span<const double> lengths, double edge, double size);

}  // namespace reeb
