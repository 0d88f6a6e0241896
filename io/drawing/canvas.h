// An image for more lines than an SVG file should have.
#pragma once

#include <cstddef>
#include <vector>

#include "io/drawing/png_image.h"
#include "io/drawing/svg_text.h"

namespace reeb::io {

// It draws on kSamples × kSamples samples a pixel, so that the edges of lines are smooth.
class Canvas {
 public:
  static constexpr std::size_t kSamples = 2;

  // Pixels of the image for each pixel of the picture: `scale`.
  Canvas(double width, double height, double scale);
  // The same on top of an image of that size.
  Canvas(const Raster& below, double scale);

  // In pixels of the picture.
  void line(PicturePoint from, PicturePoint to, double width, Rgb color);
  void disc(PicturePoint center, double radius, Rgb color);

  Raster image() const;

 private:
  double scale_;  // samples for each pixel of the picture
  std::size_t width_, height_;
  std::vector<Rgb> samples_;
};

}  // namespace reeb::io
