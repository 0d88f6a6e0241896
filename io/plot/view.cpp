#include "io/plot/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "io/text/number_text.h"
#include "libreeb/base/vector3.h"

namespace reeb::io {
namespace {

// Of any size: the largest component is divided out first.
Point unit(const Point& a) {
  const double largest = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
  const Point scaled = {a[0] / largest, a[1] / largest, a[2] / largest};
  const double length = std::sqrt(dot(scaled, scaled));
  return {scaled[0] / length, scaled[1] / length, scaled[2] / length};
}

struct Extent {
  double low = 1e308, high = -1e308;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double middle() const { return low / 2 + high / 2; }
  double size() const { return high - low; }
};

// A power of two that makes coordinates of any size at most 1: sums and differences of them do not overflow then.
double unit_of(std::span<const Point> points) {
  constexpr int kLeastExponent = -1000;
  double largest = 0;
  for (const Point& point : points)
    for (const double x : point) largest = std::max(largest, std::abs(x));
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, -std::max(exponent, kLeastExponent));
}

Point scaled(const Point& point, double by) { return {point[0] * by, point[1] * by, point[2] * by}; }

std::vector<Point> all_scaled(std::span<const Point> points, double by) {
  std::vector<Point> result;
  for (const Point& point : points) result.push_back(scaled(point, by));
  return result;
}

// The number of cells of a fixed size that the points are in.
std::size_t cells_of(const View& view, std::span<const Point> points, double cell) {
  std::vector<std::pair<std::int64_t, std::int64_t>> cells;
  for (const Point& point : points)
    cells.emplace_back(std::llround(dot(view.right, point) / cell), std::llround(dot(view.up, point) / cell));
  std::sort(cells.begin(), cells.end());
  return static_cast<std::size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
}

Point front_of(const Point& upright) { return upright[1] != 0 ? Point{0, 0, 1} : Point{0, -1, 0}; }

struct TiltedView {
  View view;
  double tilt = 0;  // degrees above level
};

std::vector<TiltedView> tilted_views(const Point& upright) {
  constexpr int kTurns = 16;
  const Point front = front_of(upright), side = cross(upright, front);
  std::vector<TiltedView> views;
  for (const double tilt : {12.0, 40.0, 80.0})
    for (int turn = 0; turn < kTurns; ++turn) {
      // A little off the axes, so that boxes show three sides.
      const double a = 2 * std::numbers::pi * (turn + 0.15) / kTurns, b = tilt * std::numbers::pi / 180;
      Point direction;
      for (std::size_t axis = 0; axis < 3; ++axis)
        direction[axis] =
            std::cos(b) * (std::cos(a) * front[axis] + std::sin(a) * side[axis]) + std::sin(b) * upright[axis];
      views.push_back({view_from(direction, upright), tilt});
    }
  return views;
}

View view_along(std::size_t axis, const Point& upright) {
  Point direction{};
  direction[axis] = 1;
  return view_from(direction, upright[axis] != 0 ? Point{0, 1, 0} : upright);
}

}  // namespace

View view_from(const Point& direction, const Point& upright) {
  View view;
  view.toward = unit(direction);
  view.right = cross(upright, view.toward);
  // From straight above, another axis is upright.
  if (dot(view.right, view.right) < 1e-12 * dot(upright, upright))
    view.right = std::abs(view.toward[1]) < 0.9 ? cross({0, 1, 0}, view.toward) : cross({0, 0, 1}, view.toward);
  view.right = unit(view.right);
  view.up = cross(view.toward, view.right);
  return view;
}

std::vector<View> views_around(const Point& upright) {
  std::vector<View> views{view_from(front_of(upright), upright)};
  for (std::size_t axis = 0; axis < 3; ++axis) views.push_back(view_along(axis, upright));
  for (const TiltedView& tilted : tilted_views(upright)) views.push_back(tilted.view);
  return views;
}

View best_view(std::span<const Point> surface, std::span<const Point> lines, const Point& upright) {
  constexpr double kLeastUnit = 1e-300;
  if (const double by = std::min(unit_of(surface), unit_of(lines)); by < kLeastUnit)
    return best_view(all_scaled(surface, by), all_scaled(lines, by), upright);
  std::array<Extent, 3> box;
  for (const auto points : {surface, lines})
    for (const Point& point : points)
      for (std::size_t axis = 0; axis < 3; ++axis) box[axis].add(point[axis]);
  const double size = std::max({box[0].size(), box[1].size(), box[2].size()});
  View best = view_from(front_of(upright), upright);
  if (!(size > 0) || !std::isfinite(size)) return best;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (box[axis].size() <= 1e-9 * size) return view_along(axis, upright);  // all is in a plane
  double best_score = 0, first_surface = 1, first_lines = 1;
  bool first = true;
  for (const auto& [view, tilt] : tilted_views(upright)) {
    const auto seen_surface = static_cast<double>(cells_of(view, surface, size / 64));
    const auto seen_lines = static_cast<double>(cells_of(view, lines, size / 160));
    if (first) {
      first_surface = std::max(seen_surface, 1.0);
      first_lines = std::max(seen_lines, 1.0);
      first = false;
    }
    // From far above little is recognized, so it must be much better.
    const double score =
        (seen_surface / first_surface + seen_lines / first_lines) * (tilt > 60 ? 0.5 : (tilt > 20 ? 0.92 : 1));
    if (score > best_score * 1.001) {
      best_score = score;
      best = view;
    }
  }
  return best;
}

Projection::Projection(const View& view, std::span<const Point> points, PicturePoint corner, double width,
                       double most_height)
    : view_(view), corner_(corner), unit_(unit_of(points)) {
  Extent across, upwards;
  for (const Point& any : points) {
    const Point point = scaled(any, unit_);
    across.add(dot(view.right, point));
    upwards.add(dot(view.up, point));
  }
  if (points.empty()) across = upwards = {0, 0};
  const double w = across.size(), h = upwards.size();
  has_extent_ = w > 0 || h > 0;
  if (has_extent_) scale_ = std::min(width / std::max(w, 1e-300), most_height / std::max(h, 1e-300));
  constexpr double kLeastHeight = 160;
  height_ = std::max(h * scale_, kLeastHeight);
  left_ = across.middle() - width / 2 / scale_;
  top_ = upwards.middle() + height_ / 2 / scale_;
}

PicturePoint Projection::place(const Point& any) const {
  const Point point = scaled(any, unit_);
  return {corner_.x + (dot(view_.right, point) - left_) * scale_, corner_.y + (top_ - dot(view_.up, point)) * scale_};
}

double Projection::depth(const Point& point) const { return dot(view_.toward, scaled(point, unit_)) * scale_; }

std::string direction_text(const Point& direction) {
  std::string text;
  for (const double component : direction) {
    if (!text.empty()) text += ',';
    text += short_number(std::round(component * 100) / 100 + 0.0, 3);
  }
  return text;
}

}  // namespace reeb::io
