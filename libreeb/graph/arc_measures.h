// What is measured on the part of a mesh that an arc stands for (docs/SEMANTICS.md, Measures of arcs).
#pragma once

#include <cstdint>

namespace reeb {

struct ArcMeasures {
  std::uint64_t vertices = 0;   // that lie on the arc
  double mean = 0;              // of the function, at these vertices; the middle of the arc if there are none
  double area = 0;              // NaN: not defined for this mesh
  double shortest_contour = 0;  // the infimum of the lengths of its contours; NaN: not known
};

}  // namespace reeb
