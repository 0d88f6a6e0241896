// Round numbers for axes, legends and scales.
#pragma once

#include <string>
#include <vector>

namespace reeb::io {

// Multiples of 1, 2 or 5 times a power of ten between `low` and `high`, about `count` of them; few if the range is
// hardly more than nothing.
std::vector<double> round_values(double low, double high, std::size_t count);

// With at most `digits` significant digits: "0.25", "1.5e+20".
std::string short_number(double value, int digits = 6);

}  // namespace reeb::io
