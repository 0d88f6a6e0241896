#include "io/export/arc_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reeb::io {
namespace {

// A place on the line: x, y, z, and the value in widths of buckets.
using Place = std::array<double, 4>;

struct Stop {
  Place place;
  double weight;
};

Place place_of(const std::array<double, 3>& point, double value) { return {point[0], point[1], point[2], value}; }
double middle_of(const Bucket& bucket) { return static_cast<double>(bucket.index) + 0.5; }

// The node below, the non-empty buckets, the node above. A node has the weight of the bucket next to it.
std::vector<Stop> stops_of(const Place& lo, std::span<const Bucket> buckets, const Place& hi) {
  std::vector<Stop> stops{{lo, 1}};
  for (const Bucket& bucket : buckets)
    if (bucket.count != 0)
      stops.push_back({place_of(bucket.mean, middle_of(bucket)), std::sqrt(static_cast<double>(bucket.count))});
  stops.push_back({hi, 1});
  stops.front().weight = stops[1].weight;
  stops.back().weight = stops[stops.size() - 2].weight;
  return stops;
}

// The weighted mean of places whose sum may be beyond the doubles.
class PlaceMean {
 public:
  void add(const Place& place, double weight) {
    for (std::size_t axis = 0; axis < sum_.size(); ++axis) {
      sum_[axis] += weight * place[axis];
      // Weights are small: so this sum is finite.
      scaled_[axis] += weight * (place[axis] * kScale);
    }
    weight_ += weight;
  }
  Place mean() const {
    Place mean;
    for (std::size_t axis = 0; axis < sum_.size(); ++axis)
      mean[axis] = std::isfinite(sum_[axis]) ? sum_[axis] / weight_ : scaled_[axis] / weight_ / kScale;
    return mean;
  }

 private:
  static constexpr double kScale = 0x1p-64;
  Place sum_{}, scaled_{};
  double weight_ = 0;
};

// Calls visit(place) for each stop between the ends.
template <class Visit>
void smooth(std::span<const Stop> stops, const Visit& visit) {
  const auto last = static_cast<std::ptrdiff_t>(stops.size()) - 1;
  const auto reach = std::min(static_cast<std::ptrdiff_t>(kLineReach), last / 3);
  for (std::ptrdiff_t i = 1; i < last; ++i) {
    PlaceMean mean;
    for (std::ptrdiff_t j = -reach; j <= reach; ++j) {
      const Stop& stop = stops[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i + j, 0, last))];
      mean.add(stop.place, stop.weight * static_cast<double>(reach + 1 - std::abs(j)));
    }
    visit(mean.mean());
  }
}

// Sums over a window of buckets, by which a straight line is fitted to their means.
struct Fit {
  double weight = 0, place = 0, places_spread = 0, spread = 0, radius_slope = 0;
  std::array<double, 3> centre{}, slope{};

  explicit Fit(std::span<const Bucket* const> window) {
    for (const Bucket* bucket : window) {
      const auto n = static_cast<double>(bucket->count);
      weight += n;
      place += n * offset(*window[0], *bucket);
      for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] += n * (bucket->mean[axis] - window[0]->mean[axis]);
    }
    place /= weight;
    for (double& x : centre) x /= weight;
    double squares = 0;
    for (const Bucket* bucket : window) {
      const double step = offset(*window[0], *bucket) - place, n = static_cast<double>(bucket->count);
      squares += n * step * step;
      radius_slope += n * step * std::sqrt(static_cast<double>(bucket->spread));
      for (std::size_t axis = 0; axis < 3; ++axis)
        slope[axis] += n * step * (bucket->mean[axis] - window[0]->mean[axis] - centre[axis]);
    }
    places_spread = squares / weight;
    if (squares > 0) {
      for (double& x : slope) x /= squares;
      radius_slope /= squares;
    }
    for (const Bucket* bucket : window) {
      const double step = offset(*window[0], *bucket) - place;
      double distance = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = bucket->mean[axis] - window[0]->mean[axis] - centre[axis] - step * slope[axis];
        distance += d * d;
      }
      spread += static_cast<double>(bucket->count) / weight * (static_cast<double>(bucket->spread) + distance);
    }
  }
  // How far the centre moves in a bucket, squared.
  double drift() const { return slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2]; }

 private:
  static double offset(const Bucket& from, const Bucket& to) {
    return static_cast<double>(to.index) - static_cast<double>(from.index);
  }
};

}  // namespace

void draw_arc(const std::array<double, 3>& lo, std::span<const Bucket> buckets, const std::array<double, 3>& hi,
              std::vector<std::array<double, 3>>& line) {
  line.clear();
  smooth(stops_of(place_of(lo, 0), buckets, place_of(hi, 0)), [&](const Place& place) {
    line.push_back({place[0], place[1], place[2]});
  });
}

void find_radii(std::span<const Bucket> buckets, std::vector<double>& radii) {
  constexpr std::uint64_t kEnough = 24;  // vertices
  constexpr std::size_t kRadiusReach = 2;
  std::vector<const Bucket*> filled;
  for (const Bucket& bucket : buckets)
    if (bucket.count != 0) filled.push_back(&bucket);
  radii.clear();
  for (std::size_t i = 0; i < filled.size(); ++i) {
    const auto window = [&](std::size_t reach) {
      const std::size_t first = i - std::min(i, reach), end = std::min(i + reach + 1, filled.size());
      return std::span(filled).subspan(first, end - first);
    };
    // As many on either side, so that a radius that grows or falls steadily is not shifted; unless there are too few.
    std::size_t reach = std::min({kRadiusReach, i, filled.size() - 1 - i});
    for (; reach < kLineReach; ++reach) {
      std::uint64_t count = 0;
      for (const Bucket* bucket : window(reach)) count += bucket->count;
      if (count >= kEnough) break;
    }
    const Fit fit(window(reach)), trend = reach > 0 ? fit : Fit(window(1));
    const double growth = trend.radius_slope * trend.radius_slope;
    // Squares of huge coordinates are beyond the doubles, and so may be what is left of them, or no number.
    const double left = fit.spread - trend.drift() / 12 - growth * (fit.places_spread + 1.0 / 12);
    radii.push_back(std::sqrt(std::min(std::max(0.0, left), std::numeric_limits<double>::max())));
  }
}

void find_line_radii(double lo, std::span<const Bucket> buckets, double hi, std::vector<double>& radii) {
  std::vector<double> own, middles;
  find_radii(buckets, own);
  for (const Bucket& bucket : buckets)
    if (bucket.count != 0) middles.push_back(middle_of(bucket));
  radii.clear();
  std::size_t next = 0;  // the first bucket beyond the place
  smooth(stops_of(place_of({}, lo), buckets, place_of({}, hi)), [&](const Place& place) {
    const double value = place[3];
    while (next < own.size() && middles[next] <= value) ++next;
    if (next == 0 || next == own.size()) return radii.push_back(next == 0 ? own.front() : own.back());
    const double share = (value - middles[next - 1]) / (middles[next] - middles[next - 1]);
    radii.push_back(own[next - 1] + (own[next] - own[next - 1]) * share);
  });
}

}  // namespace reeb::io
