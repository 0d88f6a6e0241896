// What all charts by gnuplot share.
#pragma once

#include <string>
#include <string_view>

#include "io/drawing/svg_text.h"

namespace reeb::io {

// A string of gnuplot in which nothing has a meaning of its own. It is made safe to show first.
std::string gnuplot_quoted(std::string_view text);

// The first commands of a chart of this size, which is written to standard output as SVG.
std::string begin_chart(unsigned width, unsigned height);

// What gnuplot made of it, with the heading that all pictures have: gnuplot has no bold text without a markup.
std::string with_heading(std::string chart, const Heading& heading);

// "rgb '#0072b2'".
std::string gnuplot_color(Rgb color);

}  // namespace reeb::io
