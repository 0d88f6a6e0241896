// A triangle and a linear function on it: the area below a level, and the length of the level.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace reeb {

struct ValuedPoint {
  double value = 0;
  std::array<double, 3> at{};
};

// REQUIRES: values do not descend, and are finite.
class TriangleLevels {
 public:
  TriangleLevels(const ValuedPoint& lo, const ValuedPoint& mid, const ValuedPoint& hi)
      : lo_(lo.value), mid_(mid.value), hi_(hi.value) {
    std::array<double, 3> u{}, v{}, across{};
    const double share = hi_ > lo_ ? part(mid_, lo_, hi_) : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = mid.at[k] - lo.at[k];
      v[k] = hi.at[k] - lo.at[k];
      across[k] = u[k] - share * v[k];
    }
    area_ = std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
    length_ = std::hypot(across[0], across[1], across[2]);
  }

  double area() const { return area_; }
  // REQUIRES: lo < hi in value.
  double area_below(double level) const {
    if (level <= lo_) return 0;
    if (level >= hi_) return area_;
    if (level <= mid_) return area_ * part(level, lo_, mid_) * part(level, lo_, hi_);
    return area_ * (1 - part(level, hi_, mid_) * part(level, hi_, lo_));
  }
  // The length of the level grows from 0 to this at the middle corner, and shrinks to 0.
  double longest_level() const { return length_; }

 private:
  // How far a level is on the way between two others, whose difference may be beyond the doubles.
  static double part(double level, double from, double to) {
    const double all = to - from;
    return std::isfinite(all) ? (level - from) / all : (level / 2 - from / 2) / (to / 2 - from / 2);
  }

  double lo_, mid_, hi_;
  double area_ = 0, length_ = 0;
};

}  // namespace reeb
