#include "io/plot/value_axis.h"

#include <cmath>

#include "io/text/number_text.h"

namespace reeb::io {

std::vector<double> round_values(double low, double high, std::size_t count) {
  const double rough = (high / 2 - low / 2) / static_cast<double>(count) * 2;
  if (!(rough > 0) || !std::isfinite(rough)) return {low};
  const double unit = std::pow(10, std::floor(std::log10(rough)));
  double step = unit;
  for (const double factor : {2.0, 5.0, 10.0})
    if (step < rough * 0.999) step = factor * unit;
  std::vector<double> values;
  const double first = std::ceil(low / step), last = std::floor(high / step);
  // Where the step is less than the distance of numbers near `low`, there would be no end.
  for (double i = first; i <= last && values.size() < 4 * count; i += 1) values.push_back(i == 0 ? 0 : i * step);
  return values;
}

double axis_base(double low, double high, const std::vector<double>& labels) {
  constexpr int kDigits = 3, kMostDigits = 6;
  return labels.empty() || digits_for_range(low, high, kDigits) <= kMostDigits ? 0 : labels.front();
}

}  // namespace reeb::io
