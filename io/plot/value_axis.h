// Round numbers for axes and scales.
#pragma once

#include <cstddef>
#include <vector>

namespace reeb::io {

// Multiples of 1, 2 or 5 times a power of ten between `low` and `high`, about `count` of them; few if the range is
// hardly more than nothing.
std::vector<double> round_values(double low, double high, std::size_t count);

// Where the range is so small beside the values that labels would be long: the first of these labels, from which the
// labels count. Else 0.
double axis_base(double low, double high, const std::vector<double>& labels);

}  // namespace reeb::io
