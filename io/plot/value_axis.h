// Round numbers for axes and scales.
#pragma once

#include <cstddef>
#include <vector>

namespace reeb::io {

// Multiples of 1, 2 or 5 times a power of ten between `low` and `high`, about `count` of them; few if the range is
// hardly more than nothing.
std::vector<double> round_values(double low, double high, std::size_t count);

}  // namespace reeb::io
