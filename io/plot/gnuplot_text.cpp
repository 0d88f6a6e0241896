#include "io/plot/gnuplot_text.h"

#include <algorithm>

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

std::string begin_chart(unsigned width, unsigned height) {
  return "set terminal svg size " + std::to_string(width) + ',' + std::to_string(height) +
         " font 'DejaVu Sans,13' noenhanced linewidth 1 background rgb 'white'\n"
         "set encoding utf8\n"
         "set tmargin at screen 0.87\n"
         "set border 3 linecolor rgb '#5f5f5f'\n"
         "set tics nomirror out\n"
         "set grid linecolor rgb '#d8d8d8' linewidth 0.6\n";
}

std::string with_heading(std::string chart, const Heading& heading) {
  std::string text = "<g font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n";
  append_heading(text, heading);
  text += "</g>\n";
  const std::size_t end = chart.rfind("</svg>");
  if (end == std::string::npos) return chart;
  chart.insert(end, text);
  // Instead of a title that only says "Gnuplot", with a description of it.
  constexpr std::string_view kDescriptionEnd = "</desc>\n";
  const std::size_t title = chart.find("<title>Gnuplot</title>"), description = chart.find(kDescriptionEnd);
  if (title != std::string::npos && description != std::string::npos && title < description)
    chart.erase(title, description + kDescriptionEnd.size() - title);
  const std::size_t svg = chart.find("<svg"), svg_end = std::min(chart.find('>', svg), chart.size() - 1);
  chart.insert(svg_end + 1, svg_title(heading));
  chart.insert(svg_end + 1, 1, '\n');
  return chart.insert(svg + std::string_view("<svg").size(), kSvgRole);
}

std::string gnuplot_color(Rgb color) { return "rgb '" + hex(color) + '\''; }

}  // namespace reeb::io
