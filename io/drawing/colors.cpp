#include "io/drawing/colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace reeb::io {
namespace {

// Samples of the maps "plasma" (up to 0.85) and "viridis" of Smith and van der Walt.
constexpr std::array<Rgb, 7> kPlasma = {
    {{13, 8, 135}, {84, 2, 163}, {139, 10, 165}, {185, 50, 137}, {219, 92, 104}, {244, 136, 73}, {252, 178, 48}}};
constexpr std::array<Rgb, 9> kViridis = {{{68, 1, 84},
                                          {71, 44, 122},
                                          {59, 81, 139},
                                          {44, 113, 142},
                                          {33, 144, 141},
                                          {39, 173, 129},
                                          {92, 200, 99},
                                          {170, 220, 50},
                                          {253, 231, 37}}};
constexpr std::array<Rgb, 7> kArcs = {kBlue, kVermilion, kGreen, kPurple, kOrange, kSky, {110, 80, 20}};

std::uint8_t between(std::uint8_t from, std::uint8_t to, double part) {
  return static_cast<std::uint8_t>(std::lround(from + (to - from) * part));
}

Rgb sample(std::span<const Rgb> map, double t) {
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(map.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), map.size() - 2);
  const double part = at - static_cast<double>(low);
  const Rgb a = map[low], b = map[low + 1];
  return {between(a.red, b.red, part), between(a.green, b.green, part), between(a.blue, b.blue, part)};
}

}  // namespace

std::string hex(Rgb color) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t part : {color.red, color.green, color.blue}) {
    text += kDigits[part >> 4];
    text += kDigits[part & 15];
  }
  return text;
}

Rgb line_color(double t) { return sample(kPlasma, t); }
Rgb surface_color(double t) { return sample(kViridis, t); }
Rgb arc_color(std::size_t arc) { return kArcs[arc % kArcs.size()]; }

}  // namespace reeb::io
