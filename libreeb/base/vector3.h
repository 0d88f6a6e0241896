// Vectors in space: positions and their differences.
#pragma once

#include <array>
#include <cmath>

namespace reeb {

using Vector3 = std::array<double, 3>;

inline Vector3 operator-(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double distance(const Vector3& a, const Vector3& b) {
  const Vector3 d = a - b;
  return std::sqrt(dot(d, d));
}

}  // namespace reeb
