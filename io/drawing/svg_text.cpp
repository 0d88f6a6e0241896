#include "io/drawing/svg_text.h"

#include <charconv>
#include <cmath>

#include "io/text/xml_text.h"

namespace reeb::io {

void append_coordinate(std::string& svg, double value, int decimals) {
  char digits[64];
  const double limited = std::isfinite(value) ? std::fmin(std::fmax(value, -1e6), 1e6) : 0;
  char* end = std::to_chars(digits, digits + sizeof digits, limited, std::chars_format::fixed, decimals).ptr;
  if (decimals > 0) {
    while (end[-1] == '0') --end;
    if (end[-1] == '.') --end;
  }
  const std::string_view text(digits, static_cast<std::size_t>(end - digits));
  svg += text == "-0" ? "0" : text;
}

void append_point(std::string& svg, PicturePoint point) {
  append_coordinate(svg, point.x);
  svg += ',';
  append_coordinate(svg, point.y);
}

std::string svg_title(const Heading& heading) { return "<title>" + xml_escaped(heading.title) + "</title>\n"; }

std::string begin_svg(double width, double height, const Heading& heading) {
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"";
  append_coordinate(svg, width);
  svg += "\" height=\"";
  append_coordinate(svg, height);
  svg += "\" viewBox=\"0 0 ";
  append_coordinate(svg, width);
  svg += ' ';
  append_coordinate(svg, height);
  svg += '"';
  svg += kSvgRole;
  svg += " font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n" + svg_title(heading) +
         "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  append_heading(svg, heading);
  return svg;
}

void append_text(std::string& svg, PicturePoint at, std::string_view text, const LabelStyle& style) {
  svg += "<text x=\"";
  append_coordinate(svg, at.x);
  svg += "\" y=\"";
  append_coordinate(svg, at.y);
  svg += "\" font-size=\"";
  append_coordinate(svg, style.size);
  svg += '"';
  if (std::string_view(style.anchor) != "start") svg += std::string(" text-anchor=\"") + style.anchor + '"';
  if (style.bold) svg += " font-weight=\"bold\"";
  svg += " fill=\"" + hex(style.color) + "\">" + xml_escaped(text) + "</text>\n";
}

void append_heading(std::string& svg, const Heading& heading) {
  append_text(svg, {16, 26}, heading.title, {.size = 16, .bold = true});
  append_text(svg, {16, 46}, heading.subtitle, {.size = 12, .color = kGreyInk});
}

std::string message_picture(const Heading& heading, std::string_view message) {
  constexpr double kWidth = 800, kHeight = 300;
  std::string svg = begin_svg(kWidth, kHeight, heading);
  append_text(svg, {kWidth / 2, kHeight / 2 + 20}, message, {.size = 20, .anchor = "middle"});
  return svg + "</svg>\n";
}

}  // namespace reeb::io
