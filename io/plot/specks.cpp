#include "io/plot/specks.h"

#include <algorithm>
#include <optional>

namespace reeb::io {
namespace {

constexpr double kMostBand = 0.25, kGap = 0.03;  // of the width
constexpr double kAspect = 1.3;                  // width of a picture for its height
// Distances of columns, as shares of the width; marks become as small as the last one allows.
constexpr double kSteps[] = {0.05, 0.025, 0.0125, 0.008};

struct Speck {
  std::uint32_t lower, upper;
};

// The longest first.
std::vector<Speck> sorted_specks(std::span<const std::uint32_t> specks, const GraphLayout& layout) {
  std::vector<Speck> result;
  std::vector<std::uint32_t> upper(specks.size());
  for (std::uint32_t i = 0; i < specks.size(); ++i)
    if (specks[i] != kNoSpeck) upper[specks[i]] = i;  // nodes ascend
  for (std::uint32_t i = 0; i < specks.size(); ++i)
    if (specks[i] == i) result.push_back({i, upper[i]});
  const auto length = [&](const Speck& speck) { return layout.nodes[speck.upper].y - layout.nodes[speck.lower].y; };
  std::stable_sort(result.begin(), result.end(), [&](const Speck& a, const Speck& b) { return length(a) > length(b); });
  return result;
}

// Columns in which specks have at least (nearly) the same distance upwards as the columns have across.
class Columns {
 public:
  explicit Columns(double step)
      : rows_per_height_(kParts / (step * kAspect)), most_(static_cast<std::size_t>(kMostBand / step)) {}

  // The first column with room; nothing if there is none.
  std::optional<std::size_t> take(double low, double high) {
    const std::size_t first = row(low), end = row(high) + kParts;
    for (std::size_t column = 0; column < most_; ++column) {
      if (column == taken_.size()) taken_.emplace_back(row(1) + kParts, false);
      const auto begin_of = taken_[column].begin() + static_cast<std::ptrdiff_t>(first);
      const auto end_of = taken_[column].begin() + static_cast<std::ptrdiff_t>(end);
      if (std::find(begin_of, end_of, true) != end_of) continue;
      std::fill(begin_of, end_of, true);
      return column;
    }
    return std::nullopt;
  }
  std::size_t count() const { return taken_.size(); }

 private:
  static constexpr std::size_t kParts = 4;  // rows for the height of a mark

  std::size_t row(double height) const { return static_cast<std::size_t>(height * rows_per_height_); }

  double rows_per_height_;
  std::size_t most_;
  std::vector<std::vector<bool>> taken_;
};

}  // namespace

std::vector<std::uint32_t> specks_of(const ReebGraph& graph) {
  const Degrees degree = degrees(graph);
  const auto all = [&](std::size_t node) { return degree.down[node] + degree.up[node]; };
  std::vector<std::uint32_t> specks(graph.node_count(), kNoSpeck);
  for (std::uint32_t node = 0; node < specks.size(); ++node)
    if (all(node) == 0) specks[node] = node;
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const std::size_t lo = graph.lo[arc].value(), hi = graph.hi[arc].value();
    if (all(lo) == 1 && all(hi) == 1) specks[lo] = specks[hi] = static_cast<std::uint32_t>(lo);
  }
  return specks;
}

void place_specks(const ReebGraph& graph, std::span<const std::uint32_t> specks, GraphLayout& layout) {
  const std::vector<Speck> sorted = sorted_specks(specks, layout);
  layout.parts.assign(specks.size(), GraphLayout::Part::kMain);
  if (sorted.empty()) return;
  std::vector<std::optional<std::size_t>> column(sorted.size());
  std::size_t columns = 0;
  for (const double step : kSteps) {
    Columns taken(step);
    bool fits = true;
    for (std::size_t i = 0; i < sorted.size() && (fits || step == kSteps[std::size(kSteps) - 1]); ++i) {
      column[i] = taken.take(layout.nodes[sorted[i].lower].y, layout.nodes[sorted[i].upper].y);
      fits = fits && column[i];
    }
    columns = taken.count();
    layout.speck_distance = step;
    if (fits) break;
  }
  const double band = static_cast<double>(columns - 1) * layout.speck_distance;
  const bool is_alone = std::find(specks.begin(), specks.end(), kNoSpeck) == specks.end();
  const double left = is_alone ? 0.5 - band / 2 : 1 - band, squeeze = left - kGap;
  for (std::size_t i = 0; i < specks.size(); ++i)
    if (specks[i] == kNoSpeck) layout.nodes[i].x *= squeeze;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (const std::uint32_t node : {sorted[i].lower, sorted[i].upper}) {
      layout.parts[node] = column[i] ? GraphLayout::Part::kSpeck : GraphLayout::Part::kLeftOut;
      layout.nodes[node].x = left + static_cast<double>(column[i].value_or(0)) * layout.speck_distance;
    }
    layout.left_out += !column[i];
  }
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const std::size_t lo = graph.lo[arc].value();
    if (specks[lo] != kNoSpeck)
      layout.arcs[arc] = upright_curve(layout.nodes[lo], layout.nodes[graph.hi[arc].value()], 0);
    else
      for (PicturePoint& point : layout.arcs[arc]) point.x *= squeeze;
  }
}

}  // namespace reeb::io
