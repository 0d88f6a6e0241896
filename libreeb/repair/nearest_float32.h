// Positions of new vertices in a mesh of float32 numbers.
#pragma once

namespace reeb {

// GCC 12.2 drops this rounding from some places where it vectorizes it; so each number goes through memory.
inline double nearest_float32(double x) {
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}

}  // namespace reeb
