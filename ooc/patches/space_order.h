// Places in an order in which neighbours are near each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/graph/settled_node.h"

namespace reeb::ooc {

// The numbers of the points along a Hilbert curve through their box. Points at one place keep their order.
std::vector<std::uint32_t> order_in_space(std::span<const Point> points);

}  // namespace reeb::ooc
