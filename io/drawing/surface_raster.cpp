#include "io/drawing/surface_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace reeb::io {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();

std::uint8_t byte_of(double share) { return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255)); }

Rgb grey(double shade) {
  const auto level = static_cast<std::uint8_t>(std::clamp(shade, 0.0, 255.0));
  return {level, level, level};
}

}  // namespace

SurfaceRaster::SurfaceRaster(double width, double height, double scale, SurfaceStyle style,
                             const std::vector<Probe>& probes)
    : scale_(scale * kSamples),
      style_(style),
      width_(static_cast<std::size_t>(std::ceil(width * scale)) * kSamples),
      height_(static_cast<std::size_t>(std::ceil(height * scale)) * kSamples),
      depth_(width_ * height_, kNothing),
      light_(width_ * height_, 0),
      tone_(width_ * height_, 0),
      haze_(width_ * height_, 0),
      has_probe_(width_ * height_, false),
      layers_(probes.size(), 0) {
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const double x = std::round(probes[i].x * scale_), y = std::round(probes[i].y * scale_);
    if (!(x >= 0 && y >= 0 && x < static_cast<double>(width_) && y < static_cast<double>(height_))) continue;
    probes_.push_back({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                       static_cast<float>(probes[i].depth * scale_), static_cast<std::uint32_t>(i)});
    has_probe_[probes_.back().y * width_ + probes_.back().x] = true;
  }
  std::sort(probes_.begin(), probes_.end(),
            [](const PlacedProbe& a, const PlacedProbe& b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); });
}

void SurfaceRaster::meet_probes(std::size_t x, std::size_t y, float depth) {
  auto probe = std::lower_bound(probes_.begin(), probes_.end(), std::pair(y, x),
                                [](const PlacedProbe& a, const std::pair<std::size_t, std::size_t>& b) {
                                  return std::pair<std::size_t, std::size_t>(a.y, a.x) < b;
                                });
  for (; probe != probes_.end() && probe->y == y && probe->x == x; ++probe)
    if (depth > probe->depth && layers_[probe->index] < 0xFFFF) ++layers_[probe->index];
}

void SurfaceRaster::triangle(const std::array<SurfacePoint, 3>& corners, bool is_surface) {
  struct Corner {
    double x, y, z;
  };
  std::array<Corner, 3> at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = {corners[k].x * scale_, corners[k].y * scale_, corners[k].depth * scale_};
  const auto [a, b, c] = at;
  const double left = std::ceil(std::min({a.x, b.x, c.x})), right = std::floor(std::max({a.x, b.x, c.x}));
  const double top = std::ceil(std::min({a.y, b.y, c.y})), bottom = std::floor(std::max({a.y, b.y, c.y}));
  // Most triangles of a large mesh lie between the samples.
  if (!(left <= right && top <= bottom && right >= 0 && bottom >= 0)) return;
  if (left >= static_cast<double>(width_) || top >= static_cast<double>(height_)) return;
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (nz == 0 || !(length > 0) || !std::isfinite(length)) return;
  const double area = nz;
  const double turn = (nz > 0 ? 1 : -1) / length;  // to the eye
  nx *= turn;
  ny *= turn;
  nz *= turn;
  // The light comes from the upper right (y points down), and from the eye.
  const std::uint8_t lambert = byte_of(0.35 * nx - 0.45 * ny + 0.82 * nz);
  const double slant = 1 - nz;
  const std::uint8_t facing = byte_of(slant * slant);
  const auto haze = static_cast<std::uint8_t>(is_surface ? std::lround(26 * slant * slant * slant) : 0);
  const auto first_x = static_cast<std::size_t>(std::max(left, 0.0));
  const auto last_x = static_cast<std::size_t>(std::min(right, static_cast<double>(width_ - 1)));
  const auto last_y = static_cast<std::size_t>(std::min(bottom, static_cast<double>(height_ - 1)));
  for (auto y = static_cast<std::size_t>(std::max(top, 0.0)); y <= last_y; ++y)
    for (std::size_t x = first_x; x <= last_x; ++x) {
      const double p = static_cast<double>(x) - a.x, q = static_cast<double>(y) - a.y;
      const double s = (p * vy - q * vx) / area, t = (ux * q - uy * p) / area;
      if (s < -1e-9 || t < -1e-9 || s + t > 1 + 1e-9) continue;
      const auto z = static_cast<float>(a.z + s * uz + t * vz);
      const std::size_t i = y * width_ + x;
      if (is_surface && has_probe_[i]) meet_probes(x, y, z);
      haze_[i] = static_cast<std::uint8_t>(std::min(255, haze_[i] + haze));
      if (z <= depth_[i]) continue;
      depth_[i] = z;
      light_[i] = lambert;
      tone_[i] = style_ == SurfaceStyle::kGlass
                     ? facing
                     : byte_of((1 - s - t) * corners[0].value + s * corners[1].value + t * corners[2].value);
    }
}

bool SurfaceRaster::is_edge(std::size_t x, std::size_t y) const {
  const std::size_t i = y * width_ + x;
  const auto step = static_cast<float>(0.02 * static_cast<double>(width_));
  const auto differs = [&](std::size_t other) {
    return depth_[other] < depth_[i] - step;  // also where there is nothing
  };
  return (x > 0 && differs(i - 1)) || (x + 1 < width_ && differs(i + 1)) || (y > 0 && differs(i - width_)) ||
         (y + 1 < height_ && differs(i + width_));
}

Rgb SurfaceRaster::color(std::size_t sample) const {
  if (depth_[sample] == kNothing) return kPaper;
  const double light = light_[sample] / 255.0;
  const bool edge = is_edge(sample % width_, sample / width_);
  if (style_ == SurfaceStyle::kGlass) {
    const double front = tone_[sample] / 255.0;
    const double shade = 246 - 14 * (1 - light) - 58 * front - 0.35 * std::min<int>(haze_[sample], 120);
    Rgb glass = grey(edge ? std::min(shade, 150.0) : shade);
    glass.blue = static_cast<std::uint8_t>(std::min(255, glass.blue + 6));
    glass.red = static_cast<std::uint8_t>(std::max(0, glass.red - 6));
    return glass;
  }
  if (style_ == SurfaceStyle::kSolid) return grey((158 + 84 * light) * (edge ? 0.75 : 1));
  const Rgb full = surface_color(tone_[sample] / 255.0);
  const double strength = (0.55 + 0.45 * light) * (edge ? 0.75 : 1);
  const auto lit = [&](std::uint8_t part) {
    return static_cast<std::uint8_t>(std::min(255.0, part * strength + 12 * light));
  };
  return {lit(full.red), lit(full.green), lit(full.blue)};
}

Raster SurfaceRaster::image() const {
  Raster image{width_ / kSamples, height_ / kSamples, {}};
  image.pixels.reserve(image.width * image.height);
  for (std::size_t y = 0; y < height_; y += kSamples)
    for (std::size_t x = 0; x < width_; x += kSamples) {
      std::array<unsigned, 3> sum{};
      for (std::size_t dy = 0; dy < kSamples; ++dy)
        for (std::size_t dx = 0; dx < kSamples; ++dx) {
          const Rgb one = color((y + dy) * width_ + x + dx);
          sum[0] += one.red;
          sum[1] += one.green;
          sum[2] += one.blue;
        }
      // In steps of two, which no one sees, and which pack better.
      constexpr unsigned kAll = kSamples * kSamples;
      const auto mean = [&](unsigned total) {
        return static_cast<std::uint8_t>(std::min((total / kAll + 1) & ~1u, 255u));
      };
      image.pixels.push_back({mean(sum[0]), mean(sum[1]), mean(sum[2])});
    }
  return image;
}

}  // namespace reeb::io
