// PNG and base64 against a decoder written from the specification (for zlib's part, zlib itself).
#include "io/drawing/png_image.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdlib>
#include <random>

namespace reeb::io {
namespace {

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word = (word << 8) | static_cast<std::uint8_t>(bytes[at + i]);
  return word;
}

// The rows of an 8-bit RGB image; checks every chunk's sum.
Raster decoded(const std::string& png) {
  EXPECT_EQ(png.substr(0, 8), std::string("\x89PNG\r\n\x1a\n", 8));
  Raster image;
  std::string packed;
  for (std::size_t at = 8; at < png.size();) {
    const std::uint32_t size = word_at(png, at);
    const std::string kind = png.substr(at + 4, 4), data = png.substr(at + 8, size);
    const auto* bytes = reinterpret_cast<const Bytef*>(png.data() + at + 4);
    EXPECT_EQ(word_at(png, at + 8 + size), crc32(0, bytes, size + 4)) << kind;
    if (kind == "IHDR") {
      image.width = word_at(data, 0);
      image.height = word_at(data, 4);
      EXPECT_EQ(data.substr(8), std::string("\x08\x02\0\0\0", 5));
    }
    if (kind == "IDAT") packed += data;
    at += 12 + size;
  }
  const std::size_t row_bytes = 3 * image.width;
  std::string rows((row_bytes + 1) * image.height, '\0');
  uLongf size = rows.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(rows.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                       packed.size()),
            Z_OK);
  EXPECT_EQ(size, rows.size());
  std::vector<int> above(row_bytes, 0), row(row_bytes, 0);
  for (std::size_t y = 0; y < image.height; ++y) {
    const auto* line = reinterpret_cast<const std::uint8_t*>(rows.data()) + y * (row_bytes + 1);
    EXPECT_LE(line[0], 4) << "a filter";
    for (std::size_t i = 0; i < row_bytes; ++i) {
      const int a = i < 3 ? 0 : row[i - 3], b = above[i], c = i < 3 ? 0 : above[i - 3];
      const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
      const int paeth = pa <= pb && pa <= pc ? a : (pb <= pc ? b : c);
      const std::array<int, 5> predicted{0, a, b, (a + b) / 2, paeth};
      row[i] = (line[1 + i] + predicted.at(line[0])) & 255;
    }
    for (std::size_t i = 0; i < row_bytes; i += 3)
      image.pixels.push_back({static_cast<std::uint8_t>(row[i]), static_cast<std::uint8_t>(row[i + 1]),
                              static_cast<std::uint8_t>(row[i + 2])});
    above = row;
  }
  return image;
}

TEST(PngImage, KeepsEveryPixel) {
  std::mt19937 random(3);
  for (const auto& [width, height] : {std::array<std::size_t, 2>{1, 1}, {7, 3}, {64, 20}}) {
    Raster image{width, height, {}};
    for (std::size_t i = 0; i < width * height; ++i)
      image.pixels.push_back(
          {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random() % 3), static_cast<std::uint8_t>(i)});
    const Raster back = decoded(encode_png(image));
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.pixels, image.pixels);
  }
}

TEST(PngImage, IsInTheSvgAsBase64) {
  const Raster image{2, 1, {{1, 2, 3}, {4, 5, 6}}};
  std::string svg;
  append_image(svg, image, {0, 0}, 2, 1);
  const std::string begin = "base64,";
  const std::size_t from = svg.find(begin) + begin.size(), to = svg.find('"', from);
  const std::string text = svg.substr(from, to - from);
  ASSERT_EQ(text.size() % 4, 0u);
  // Six bits a character, by their order in the alphabet.
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6) | static_cast<unsigned>(alphabet.find(c));
    held += 6;
    if (held >= 8) bytes.push_back(static_cast<char>((bits >> (held -= 8)) & 255));
  }
  EXPECT_EQ(bytes, encode_png(image));
}

// Noise does not pack, so less of it is shown.
TEST(PngImage, IsMadeSmallerInTheSvg) {
  std::mt19937 random(4);
  Raster image{1001, 999, {}};
  for (std::size_t i = 0; i < image.width * image.height; ++i)
    image.pixels.push_back({static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                            static_cast<std::uint8_t>(random())});
  std::string svg;
  append_image(svg, image, {0, 0}, 500, 500);
  EXPECT_LT(svg.size(), kMostPngBytes * 4 / 3 + 1000);
  EXPECT_GT(svg.size(), kMostPngBytes / 4);
  EXPECT_NE(svg.find("width=\"500\""), std::string::npos);
}

}  // namespace
}  // namespace reeb::io
