// A node of the final graph, as it leaves the engine.
#pragma once

#include <array>

#include "libreeb/base/sweep_key.h"

namespace reeb {

using Point = std::array<double, 3>;

// A node of the final graph with its position (zeros when positions are not tracked).
struct SettledNode {
  SweepKey key;
  Point position{};
};

}  // namespace reeb
