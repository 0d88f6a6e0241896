// The range of a set of values.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace reeb {

// The least and the greatest value; min > max before the first one.
struct ValueRange {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();

  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }

  // share * (max - min), without overflow. Never falls when the range grows.
  // REQUIRES: share >= 0; at least one value was added.
  double part(double share) const {
    const double width = max - min;
    return std::isfinite(width) ? share * width : 2 * (share * (max / 2 - min / 2));
  }
};

}  // namespace reeb
