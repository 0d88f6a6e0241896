// A surface of any number of triangles as an image: a small z-buffer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/drawing/colors.h"
#include "io/drawing/png_image.h"

namespace reeb::io {

enum class SurfaceStyle { kGlass, kSolid, kValue, kNone };

// A corner of a triangle: its place in the picture, how near it is in the same unit, and the share of the range of the
// function that lies below its value.
struct SurfacePoint {
  float x = 0, y = 0, depth = 0, value = 0;
};

// A place of which one wants to know how many layers of the surface are in front of it.
struct Probe {
  float x = 0, y = 0, depth = 0;
};

// MEMORY: 7 bytes a sample, kSamples² samples a pixel; and the probes.
class SurfaceRaster {
 public:
  static constexpr std::size_t kSamples = 2;

  // An image of `scale` pixels for each pixel of the picture.
  SurfaceRaster(double width, double height, double scale, SurfaceStyle style, const std::vector<Probe>& probes);

  // Faces of cells inside a volume never hide its surface, so they are drawn, with is_surface = false: they do not
  // count as layers.
  void triangle(const std::array<SurfacePoint, 3>& corners, bool is_surface);

  // Of each probe, once all triangles are drawn.
  const std::vector<std::uint16_t>& layers() const { return layers_; }
  Raster image() const;

 private:
  struct PlacedProbe {
    std::uint32_t x, y;
    float depth;
    std::uint32_t index;
  };

  void meet_probes(std::size_t x, std::size_t y, float depth);
  Rgb color(std::size_t sample) const;
  bool is_edge(std::size_t x, std::size_t y) const;

  double scale_;
  SurfaceStyle style_;
  std::size_t width_, height_;  // in samples
  std::vector<float> depth_;
  std::vector<std::uint8_t> light_;
  std::vector<std::uint8_t> tone_;  // the value; of glass how slanting the nearest layer is
  std::vector<std::uint8_t> haze_;  // of glass: slanting layers, added up
  std::vector<bool> has_probe_;
  std::vector<PlacedProbe> probes_;  // by row, then by column
  std::vector<std::uint16_t> layers_;
};

}  // namespace reeb::io
