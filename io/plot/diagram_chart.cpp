#include "io/plot/diagram_chart.h"

#include <algorithm>
#include <numeric>

#include "io/plot/gnuplot_text.h"
#include "io/plot/value_axis.h"
#include "io/text/number_text.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

struct TypeStyle {
  PairType type;
  const char *noun, *nouns;
  const char* block;
  int mark;
  double size;
  Rgb color;
};
// In the order of drawing: what is rare comes last, on top.
constexpr std::array<TypeStyle, 4> kStyles = {
    {{PairType::kOrd0, "minimum", "minima", "$minima", 11, 0.6, kBlue},
     {PairType::kRel1, "maximum", "maxima", "$maxima", 9, 0.6, kVermilion},
     {PairType::kExt1, "loop", "loops", "$loops", 6, 0.7, kGreen},
     {PairType::kExt0, "component", "components", "$components", 5, 0.55, kInk}}};

bool is_above_the_diagonal(PairType type) { return type == PairType::kOrd0 || type == PairType::kExt0; }

}  // namespace

DiagramPoints::DiagramPoints(std::uint64_t pairs, double low, double high)
    : low_(low), high_(high), thins_(pairs > kMostPoints) {
  if (thins_)
    for (std::vector<bool>& taken : taken_) taken.assign(kCells * kCells, false);
}

std::size_t DiagramPoints::cell(const Point& point, std::size_t cells) const {
  const double last = static_cast<double>(cells - 1);
  const auto along = [&](double value) {
    const double part = high_ > low_ ? (value / 2 - low_ / 2) / (high_ / 2 - low_ / 2) : 0;
    return static_cast<std::size_t>(std::clamp(part * static_cast<double>(cells), 0.0, last));
  };
  return along(point.y) * cells + along(point.x);
}

void DiagramPoints::add(PairType type, double lo, double hi) {
  const auto index = static_cast<std::size_t>(type);
  ++counts_[index];
  const Point point = is_above_the_diagonal(type) ? Point{lo, hi} : Point{hi, lo};
  if (thins_) {
    const std::size_t at = cell(point, kCells);
    if (taken_[index][at]) return;
    taken_[index][at] = true;
  }
  points_[index].push_back(point);
}

void DiagramPoints::finish() {
  if (!thins_) return;
  const auto total = [this] {
    return std::accumulate(points_.begin(), points_.end(), std::size_t{0},
                           [](std::size_t sum, const auto& points) { return sum + points.size(); });
  };
  for (std::size_t cells = kCells * 3 / 4; total() > kMostPoints; cells = cells * 3 / 4)
    for (std::size_t type = 0; type < points_.size(); ++type) {
      taken_[type].assign(cells * cells, false);
      std::erase_if(points_[type], [&](const Point& point) {
        const std::size_t at = cell(point, cells);
        if (taken_[type][at]) return true;
        taken_[type][at] = true;
        return false;
      });
    }
}

std::string diagram_chart(const std::string& function, const DiagramPoints& points) {
  std::string text = begin_chart(840, 640);
  // Values of any size: gnuplot fails where the range is nothing, or more than a number.
  const double low = std::max(points.low(), -1e300), high = std::min(points.high(), 1e300);
  const double margin = high > low ? (high - low) * 0.03 : std::max(1.0, std::abs(low)) * 0.5;
  const double base = axis_base(low, high, round_values(low, high, 5));
  const std::string less = base == 0 ? "" : ", less " + short_number(base, digits_for_range(low, high));
  for (const char* axis : {"set xrange [", "set yrange ["}) {
    text += axis;
    append_double(text, low - margin - base);
    text += ':';
    append_double(text, high + margin - base);
    text += "]\n";
  }
  text += "set xlabel " + gnuplot_quoted("f = " + function + " where the feature begins" + less) + "\nset ylabel " +
          gnuplot_quoted("f = " + function + " where it ends" + less) +
          "\nset size square\n"
          "set key at screen 0.69, screen 0.86 left top vertical Left reverse samplen 1\n"  // beside the square
          "set rmargin at screen 0.67\nset lmargin at screen 0.11\nset bmargin at screen 0.11\n"
          "set format '%g'\n";
  std::size_t drawn = 0;
  for (const TypeStyle& style : kStyles) drawn += points.of(style.type).size();
  const bool crowded = drawn > 2000;
  std::string plot = "plot x with lines linecolor rgb '#9a9a9a' dashtype 2 notitle";
  for (const TypeStyle& style : kStyles) {
    text += std::string(style.block) + " << END\n";
    if (points.of(style.type).empty()) text += "NaN NaN\n";
    for (const DiagramPoints::Point& point : points.of(style.type)) {
      append_double(text, point.x - base);
      text += ' ';
      append_double(text, point.y - base);
      text += '\n';
    }
    text += "END\n";
    plot +=
        std::string(", ") + style.block + " using 1:2 with points pointtype " + std::to_string(style.mark) +
        " pointsize " + std::to_string(crowded ? 0.35 : style.size) + " linecolor " + gnuplot_color(style.color) +
        " title " +
        gnuplot_quoted(with_commas(points.count(style.type)) + ' ' +
                       (points.count(style.type) == 1 ? style.noun : style.nouns) + " (" + name_of(style.type) + ')');
  }
  return text + plot + '\n';
}

}  // namespace reeb::io
