#include "io/plot/loop_chart.h"

#include <algorithm>
#include <cmath>

#include "io/plot/gnuplot_text.h"
#include "io/text/number_text.h"

namespace reeb::io {
namespace {

constexpr double kFloor = 0.7;  // the lower end of the axis; zero has no place on it
constexpr std::size_t kColumnLetters = 33;

std::string block_name(const char* kind, std::size_t i) { return std::string("$") + kind + std::to_string(i); }

std::string point_line(double x, double y) {
  std::string line;
  append_double(line, x);
  line += ' ';
  append_double(line, y);
  return line + '\n';
}

}  // namespace

std::vector<std::pair<double, std::size_t>> loop_steps(std::span<const double> percents) {
  std::vector<std::pair<double, std::size_t>> steps;
  const std::size_t count = percents.size();
  if (count <= kMostCorners) {
    for (std::size_t i = 0; i < count; ++i) steps.emplace_back(percents[i], count - i);
    return steps;
  }
  // The first and the last loop of each of kMostCorners / 2 columns.
  const double low = std::log(percents.front()), span = std::log(percents.back()) - low;
  const auto column = [&](double percent) {
    return span > 0 ? static_cast<std::size_t>((std::log(percent) - low) / span * (kMostCorners / 2 - 1)) : 0;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const bool begins = i == 0 || column(percents[i - 1]) != column(percents[i]);
    const bool ends = i + 1 == count || column(percents[i + 1]) != column(percents[i]);
    if (begins || ends) steps.emplace_back(percents[i], count - i);
  }
  return steps;
}

std::string loop_chart(std::span<const LoopSeries> series) {
  double least = 100, most = 0;
  std::size_t loops = 0;
  for (const LoopSeries& one : series) {
    if (one.percents.empty()) continue;
    least = std::min(least, one.percents.front());
    most = std::max(most, one.percents.back());
    loops = std::max(loops, one.percents.size());
  }
  const double left = std::pow(10, std::floor(std::log10(std::min(least * 0.9, 10.0))));
  const double top = std::pow(10, std::ceil(std::log10(static_cast<double>(loops) * 1.2)));
  // Under the axis, names of series in two columns; in one, if that is too narrow for a name.
  const unsigned key_columns =
      std::ranges::any_of(series, [](const LoopSeries& one) { return one.name.size() > kColumnLetters; }) ? 1 : 2;
  const auto key_rows = static_cast<unsigned>(series.size() > 1 ? (series.size() + key_columns - 1) / key_columns : 0);
  const unsigned height = 540 + (key_rows == 0 ? 0 : 20 + 22 * key_rows);
  std::string text = begin_chart(800, height);
  text += "set bmargin at screen ";
  append_double(text, (height - 474.0) / height);
  text += '\n';
  text += "set logscale xy\nset xrange [";
  append_double(text, left);
  text += ":100]\nset yrange [";
  append_double(text, kFloor);
  text += ':';
  append_double(text, top);
  text +=
      "]\nset xlabel 'persistence, per cent of the range of the function'\n"
      "set ylabel 'loops of at least this persistence'\n"
      "set format '%g'\n";
  text += series.size() > 1 ? "set key at screen 0.08, screen 0.02 left bottom Left reverse vertical maxcols " +
                                  std::to_string(key_columns) + " maxrows " + std::to_string(key_rows) + '\n'
                            : "unset key\n";
  std::string plot = "plot ";
  for (std::size_t i = 0; i < series.size(); ++i) {
    const LoopSeries& one = series[i];
    const std::string color = gnuplot_color(arc_color(i));
    const std::string dashes = std::to_string(i / 7 + 1);  // colours repeat
    text += block_name("steps", i) + " << END\n";
    if (one.percents.empty()) {
      text += "NaN NaN\n";
    } else {
      text += point_line(left, static_cast<double>(one.percents.size()));
      for (const auto& [percent, count] : loop_steps(one.percents))
        text += point_line(percent, static_cast<double>(count));
      text += point_line(one.percents.back(), kFloor);
    }
    text += "END\n";
    plot += (i == 0 ? "" : ", ") + block_name("steps", i) + " using 1:2 with fsteps linewidth 2 dashtype " + dashes +
            " linecolor " + color + " title " + gnuplot_quoted(one.name);
  }
  return text + plot + '\n';
}

}  // namespace reeb::io
