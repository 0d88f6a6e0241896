// The colours of pictures. All kinds of colour vision distinguish them, and so does a print in grey where they show
// values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace reeb::io {

struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

inline constexpr Rgb kInk{34, 34, 34}, kGreyInk{95, 95, 95}, kPaper{255, 255, 255};
// The palette of Okabe and Ito.
inline constexpr Rgb kBlue{0, 114, 178}, kVermilion{213, 94, 0}, kGreen{0, 158, 115}, kOrange{230, 159, 0},
    kSky{86, 180, 233}, kPurple{204, 121, 167};

// "#0072b2".
std::string hex(Rgb color);

// For t from 0 to 1; darker is less. The lines of a skeleton stay clear of white.
Rgb line_color(double t);     // indigo, magenta, orange
Rgb surface_color(double t);  // viridis: violet, green, yellow
// Neighbours in a list are easy to distinguish.
Rgb arc_color(std::size_t arc);

}  // namespace reeb::io
