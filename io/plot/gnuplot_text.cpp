#include "io/plot/gnuplot_text.h"

#include "libreeb/base/printable.h"

namespace reeb::io {

std::string gnuplot_quoted(std::string_view text) {
  std::string quoted = "'";
  for (const char c : printable(text)) {
    quoted += c;
    if (c == '\'') quoted += c;
  }
  return quoted + '\'';
}

std::string begin_chart(const Heading& heading, unsigned width, unsigned height) {
  return "set terminal svg size " + std::to_string(width) + ',' + std::to_string(height) +
         " font 'DejaVu Sans,13' noenhanced linewidth 1 background rgb 'white'\n"
         "set encoding utf8\n"
         "set label 1 " +
         gnuplot_quoted(heading.title) + " at screen 0.02, screen 0.955 left font 'DejaVu Sans,16' textcolor " +
         gnuplot_color(kInk) + "\nset label 2 " + gnuplot_quoted(heading.subtitle) +
         " at screen 0.02, screen 0.915 left font 'DejaVu Sans,12' textcolor " + gnuplot_color(kGreyInk) +
         "\nset tmargin at screen 0.87\n"
         "set border 3 linecolor rgb '#5f5f5f'\n"
         "set tics nomirror out\n"
         "set grid linecolor rgb '#d8d8d8' linewidth 0.6\n";
}

std::string gnuplot_color(Rgb color) { return "rgb '" + hex(color) + '\''; }

}  // namespace reeb::io
