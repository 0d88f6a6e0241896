// Pieces of SVG files, as text.
#pragma once

#include <string>
#include <string_view>

#include "io/drawing/colors.h"

namespace reeb::io {

// A point of a picture, in pixels from its upper left corner.
struct PicturePoint {
  double x = 0, y = 0;
};

// Appends a coordinate with at most `decimals` digits after the point.
void append_coordinate(std::string& svg, double value, int decimals = 1);
// Appends "X,Y".
void append_point(std::string& svg, PicturePoint point);

// The two lines above a picture.
struct Heading {
  std::string title, subtitle;
};
inline constexpr double kHeadingHeight = 56;  // pixels
void append_heading(std::string& svg, const Heading& heading);

// What programs that read a picture aloud say of it.
inline constexpr const char* kSvgRole = " role=\"img\"";
std::string svg_title(const Heading& heading);

// The first lines of a picture on white, with its heading. It ends with "</svg>\n".
std::string begin_svg(double width, double height, const Heading& heading);

struct LabelStyle {
  double size = 13;
  const char* anchor = "start";  // or "middle", "end"
  bool bold = false;
  Rgb color = kInk;
};
void append_text(std::string& svg, PicturePoint at, std::string_view text, const LabelStyle& style = {});

// A picture that only says something.
std::string message_picture(const Heading& heading, std::string_view message);

}  // namespace reeb::io
