// Images as PNG, and as an element of an SVG file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/drawing/colors.h"
#include "io/drawing/svg_text.h"

namespace reeb::io {

struct Raster {
  std::size_t width = 0, height = 0;
  std::vector<Rgb> pixels;  // rows from above
};

// The bytes of a PNG file. MEMORY: three bytes a pixel, and the result. THROWS: Error{kResource} if it is not enough.
std::string encode_png(const Raster& image);

// An <image> from `at`, with this width and height in the picture, which holds the PNG itself. The image is made
// smaller until that has at most kMostPngBytes, so that pictures have at most 2 MB.
inline constexpr std::size_t kMostPngBytes = 1'250'000;
void append_image(std::string& svg, const Raster& image, PicturePoint at, double width, double height);

}  // namespace reeb::io
