#include "io/drawing/png_image.h"

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string_view>

namespace reeb::io {
namespace {

void append_word(std::string& bytes, std::uint32_t word) {  // big endian
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>((word >> shift) & 0xFF));
}

void append_chunk(std::string& png, std::string_view kind, std::string_view data) {
  append_word(png, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = png.size();
  png += kind;
  png += data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(png.data() + begin), static_cast<uInt>(kind.size() + data.size()));
  append_word(png, static_cast<std::uint32_t>(sum));
}

std::uint8_t paeth(std::uint8_t left, std::uint8_t above, std::uint8_t corner) {
  const int guess = left + above - corner;
  const int a = std::abs(guess - left), b = std::abs(guess - above), c = std::abs(guess - corner);
  return a <= b && a <= c ? left : (b <= c ? above : corner);
}

// Each row as differences from its neighbours to the left and above, which are small in shaded surfaces.
std::string filtered_rows(const Raster& image) {
  const std::size_t row_bytes = 3 * image.width;
  std::string rows;
  rows.reserve((row_bytes + 1) * image.height);
  std::vector<std::uint8_t> above(row_bytes), row(row_bytes);
  for (std::size_t y = 0; y < image.height; ++y) {
    for (std::size_t x = 0; x < image.width; ++x) {
      const Rgb pixel = image.pixels[y * image.width + x];
      row[3 * x] = pixel.red;
      row[3 * x + 1] = pixel.green;
      row[3 * x + 2] = pixel.blue;
    }
    rows.push_back(4);  // the filter "Paeth"
    for (std::size_t i = 0; i < row_bytes; ++i) {
      const std::uint8_t left = i < 3 ? std::uint8_t{0} : row[i - 3];
      const std::uint8_t corner = i < 3 ? std::uint8_t{0} : above[i - 3];
      rows.push_back(static_cast<char>(row[i] - paeth(left, above[i], corner)));
    }
    row.swap(above);
  }
  return rows;
}

void append_base64(std::string& text, std::string_view bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = (word << 8) | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text.push_back(i + k <= bytes.size() ? kDigits[(word >> (18 - 6 * k)) & 63] : '=');
  }
}

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
  std::string png("\x89PNG\r\n\x1a\n", 8);
  std::string head;
  append_word(head, static_cast<std::uint32_t>(image.width));
  append_word(head, static_cast<std::uint32_t>(image.height));
  head += std::string_view("\x08\x02\0\0\0", 5);  // 8 bits each of red, green and blue
  append_chunk(png, "IHDR", head);
  const std::string rows = filtered_rows(image);
  uLongf bytes = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(bytes, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &bytes, reinterpret_cast<const Bytef*>(rows.data()),
                static_cast<uLong>(rows.size()), 9) != Z_OK)
    throw std::bad_alloc();  // compressBound leaves no other reason
  packed.resize(bytes);
  append_chunk(png, "IDAT", packed);
  append_chunk(png, "IEND", {});
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
  append_base64(svg, png);
  svg += "\"/>\n";
}

}  // namespace reeb::io
