#include "io/drawing/png_image.h"

#include <png.h>

#include <array>
#include <cstdint>
#include <string_view>

#include "io/text/base64_encoder.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// Half as wide and high.
Raster halved(const Raster& image) {
  Raster half{image.width / 2, image.height / 2, {}};
  for (std::size_t y = 0; y < half.height; ++y)
    for (std::size_t x = 0; x < half.width; ++x) {
      std::array<unsigned, 3> sum{};
      for (const std::size_t i : {2 * y * image.width + 2 * x, 2 * y * image.width + 2 * x + 1,
                                  (2 * y + 1) * image.width + 2 * x, (2 * y + 1) * image.width + 2 * x + 1}) {
        sum[0] += image.pixels[i].red;
        sum[1] += image.pixels[i].green;
        sum[2] += image.pixels[i].blue;
      }
      half.pixels.push_back({static_cast<std::uint8_t>(sum[0] / 4), static_cast<std::uint8_t>(sum[1] / 4),
                             static_cast<std::uint8_t>(sum[2] / 4)});
    }
  return half;
}

}  // namespace

std::string encode_png(const Raster& image) {
  static_assert(sizeof(Rgb) == 3, "pixels are passed to libpng as they lie in memory");
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  head.width = static_cast<png_uint_32>(image.width);
  head.height = static_cast<png_uint_32>(image.height);
  head.format = PNG_FORMAT_RGB;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(head);
  std::string png(bytes, '\0');
  if (png_image_write_to_memory(&head, png.data(), &bytes, 0, image.pixels.data(), 0, nullptr) == 0)
    throw Error(ErrorKind::kResource, std::string("the image cannot be packed: ") + head.message,
                "close other programs, so that more memory is free");
  png.resize(bytes);
  return png;
}

void append_image(std::string& svg, const Raster& image, PicturePoint at, double width, double height) {
  std::string png = encode_png(image);
  for (Raster smaller = image; png.size() > kMostPngBytes; png = encode_png(smaller)) smaller = halved(smaller);
  svg += "<image x=\"";
  append_coordinate(svg, at.x);
  svg += "\" y=\"";
  append_coordinate(svg, at.y);
  svg += "\" width=\"";
  append_coordinate(svg, width);
  svg += "\" height=\"";
  append_coordinate(svg, height);
  svg += "\" preserveAspectRatio=\"none\" xlink:href=\"data:image/png;base64,";
  Base64Encoder data([&](std::string_view digits) { svg += digits; });
  data.put(png);
  data.finish();
  svg += "\"/>\n";
}

}  // namespace reeb::io
