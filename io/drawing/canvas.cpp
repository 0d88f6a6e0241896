#include "io/drawing/canvas.h"

#include <algorithm>
#include <cmath>

namespace reeb::io {

Canvas::Canvas(double width, double height, double scale)
    : scale_(scale * kSamples),
      width_(static_cast<std::size_t>(std::ceil(width * scale)) * kSamples),
      height_(static_cast<std::size_t>(std::ceil(height * scale)) * kSamples),
      samples_(width_ * height_, kPaper) {}

Canvas::Canvas(const Raster& below, double scale)
    : scale_(scale * kSamples), width_(below.width * kSamples), height_(below.height * kSamples) {
  samples_.reserve(width_ * height_);
  for (std::size_t y = 0; y < height_; ++y)
    for (std::size_t x = 0; x < width_; ++x)
      samples_.push_back(below.pixels[y / kSamples * below.width + x / kSamples]);
}

void Canvas::disc(PicturePoint center, double radius, Rgb color) {
  const double x = center.x * scale_, y = center.y * scale_, r = std::max(radius * scale_, 0.6);
  const auto first_row = static_cast<std::ptrdiff_t>(std::max(0.0, std::ceil(y - r)));
  const auto last_row = static_cast<std::ptrdiff_t>(std::min(static_cast<double>(height_) - 1, std::floor(y + r)));
  for (std::ptrdiff_t row = first_row; row <= last_row; ++row) {
    const double dy = static_cast<double>(row) - y;
    const double half = std::sqrt(std::max(0.0, r * r - dy * dy));
    const auto first = static_cast<std::ptrdiff_t>(std::max(0.0, std::ceil(x - half)));
    const auto last = static_cast<std::ptrdiff_t>(std::min(static_cast<double>(width_) - 1, std::floor(x + half)));
    for (std::ptrdiff_t i = first; i <= last; ++i)
      samples_[static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(i)] = color;
  }
}

void Canvas::line(PicturePoint from, PicturePoint to, double width, Rgb color) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const double step = std::max(width / 3, 0.7 / scale_);
  const auto steps = static_cast<std::size_t>(std::ceil(length / step));
  for (std::size_t i = 0; i <= steps; ++i) {
    const double t = steps == 0 ? 0 : static_cast<double>(i) / static_cast<double>(steps);
    disc({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)}, width / 2, color);
  }
}

Raster Canvas::image() const {
  Raster image{width_ / kSamples, height_ / kSamples, {}};
  image.pixels.reserve(image.width * image.height);
  for (std::size_t y = 0; y < height_; y += kSamples)
    for (std::size_t x = 0; x < width_; x += kSamples) {
      unsigned red = 0, green = 0, blue = 0;
      for (std::size_t dy = 0; dy < kSamples; ++dy)
        for (std::size_t dx = 0; dx < kSamples; ++dx) {
          const Rgb sample = samples_[(y + dy) * width_ + x + dx];
          red += sample.red;
          green += sample.green;
          blue += sample.blue;
        }
      constexpr unsigned kAll = kSamples * kSamples;
      image.pixels.push_back({static_cast<std::uint8_t>(red / kAll), static_cast<std::uint8_t>(green / kAll),
                              static_cast<std::uint8_t>(blue / kAll)});
    }
  return image;
}

}  // namespace reeb::io
