#include "io/plot/dot_layout.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "io/plot/branch_places.h"

namespace reeb::io {
namespace {

constexpr std::size_t kRows = 36;  // of dot

std::size_t row_of(double height) {
  return std::min(kRows - 1, static_cast<std::size_t>(height * static_cast<double>(kRows)));
}

// Words of one line after the other.
class PlainText {
 public:
  explicit PlainText(std::string_view text) : text_(text) {}

  bool next_line() {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line_ = text_.substr(at_, end - at_);
    at_ = end + 1;
    return true;
  }
  std::string_view word() {
    const std::size_t begin = std::min(line_.find_first_not_of(' '), line_.size());
    const std::size_t end = std::min(line_.find(' ', begin), line_.size());
    const std::string_view word = line_.substr(begin, end - begin);
    line_.remove_prefix(end);
    return word;
  }
  template <class Number>
  std::optional<Number> number() {
    const std::string_view digits = word();
    Number value{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    return value;
  }

 private:
  std::string_view text_, line_;
  std::size_t at_ = 0;
};

constexpr std::uint32_t kNoSpeck = ~std::uint32_t{0};

// Components of one node or one arc, which dot would place far and wide: for each of their nodes the lower one of the
// component, for others kNoSpeck.
std::vector<std::uint32_t> specks_of(const ReebGraph& graph) {
  const Neighbors neighbors = neighbors_of(graph);
  const auto degree = [&](std::size_t node) { return neighbors.offsets[node + 1] - neighbors.offsets[node]; };
  std::vector<std::uint32_t> specks(graph.node_count(), kNoSpeck);
  for (std::uint32_t node = 0; node < specks.size(); ++node) {
    if (degree(node) == 0) specks[node] = node;
    if (degree(node) != 1) continue;
    const std::uint32_t other = neighbors.neighbors[neighbors.offsets[node]];
    if (degree(other) == 1) specks[node] = std::min(node, other);
  }
  return specks;
}

double distance(const PicturePoint& a, const PicturePoint& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// To the right of the nodes that have places, in as few columns as they fit.
void place_specks(std::span<const std::uint32_t> specks, std::span<const double> height, GraphLayout& layout) {
  constexpr double kDistance = 0.03;  // from one to the next above it
  double edge = 0;
  for (std::size_t i = 0; i < specks.size(); ++i)
    if (specks[i] == kNoSpeck) edge = std::max(edge, layout.nodes[i].x);
  std::vector<std::uint32_t> upper(specks.size());
  for (std::uint32_t i = 0; i < specks.size(); ++i)
    if (specks[i] != kNoSpeck) upper[specks[i]] = i;  // nodes ascend
  std::vector<double> tops;                           // of the columns
  for (std::uint32_t i = 0; i < specks.size(); ++i) {
    if (specks[i] != i) continue;
    const auto column = std::find_if(tops.begin(), tops.end(), [&](double top) { return top < height[i] - kDistance; });
    const double x = edge + 0.3 + 0.2 * static_cast<double>(column - tops.begin());
    if (column == tops.end())
      tops.push_back(height[upper[i]]);
    else
      *column = height[upper[i]];
    layout.nodes[i] = {x, height[i]};
    layout.nodes[upper[i]] = {x, height[upper[i]]};
  }
  if (tops.empty() || edge == 0) return;
  // At most a quarter of the picture.
  const double squeeze = std::min(1.0, edge / 3 / (0.2 * static_cast<double>(tops.size())));
  for (std::size_t i = 0; i < specks.size(); ++i)
    if (specks[i] != kNoSpeck) layout.nodes[i].x = edge + 0.3 + (layout.nodes[i].x - edge - 0.3) * squeeze;
}

}  // namespace

std::string dot_text(const ReebGraph& graph) {
  const std::vector<double> height = heights(graph);
  std::string text =
      "graph {\n"
      "rankdir=BT; nodesep=0.15; ranksep=0.2; nslimit=4; mclimit=2;\n"
      "node [shape=circle, fixedsize=true, width=0.15, label=\"\"];\n";
  for (std::size_t row = 0; row + 1 < kRows; ++row)
    text += 'r' + std::to_string(row) + " -- r" + std::to_string(row + 1) + " [style=invis];\n";
  const std::vector<std::uint32_t> specks = specks_of(graph);
  std::vector<std::string> rows(kRows);
  for (std::size_t i = 0; i < height.size(); ++i)
    if (specks[i] == kNoSpeck) rows[row_of(height[i])] += ' ' + std::to_string(i) + ';';
  for (std::size_t row = 0; row < kRows; ++row)
    text += "{ rank=same; r" + std::to_string(row) + ';' + rows[row] + " }\n";
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc)
    if (specks[graph.lo[arc].value()] == kNoSpeck)
      text += std::to_string(graph.lo[arc].value()) + " -- " + std::to_string(graph.hi[arc].value()) + ";\n";
  return text + "}\n";
}

std::optional<GraphLayout> read_dot_layout(const ReebGraph& graph, std::string_view plain) {
  using Ends = std::pair<std::size_t, std::size_t>;
  const std::vector<double> height = heights(graph);
  const std::vector<std::uint32_t> specks = specks_of(graph);
  GraphLayout layout;
  layout.nodes.assign(graph.node_count(), {-1, 0});
  std::vector<PicturePoint> placed(graph.node_count());  // by dot
  std::multimap<Ends, std::vector<PicturePoint>> curves;
  double lowest = 0, highest = 1;  // in inches
  PlainText text(plain);
  while (text.next_line()) {
    const std::string_view item = text.word();
    if (item == "node") {
      const std::string_view name = text.word();
      if (name == "r0" || name == 'r' + std::to_string(kRows - 1)) {
        text.word();
        if (const auto y = text.number<double>()) (name == "r0" ? lowest : highest) = *y;
        continue;
      }
      if (name.starts_with('r')) continue;
      std::size_t node = 0;
      std::from_chars(name.data(), name.data() + name.size(), node);
      const auto x = text.number<double>(), y = text.number<double>();
      if (node >= layout.nodes.size() || !x || !y) return std::nullopt;
      placed[node] = {*x, *y};
      layout.nodes[node] = {*x, height[node]};
    } else if (item == "edge") {
      const auto tail = text.number<std::size_t>();
      if (!tail) continue;  // between rows
      const auto head = text.number<std::size_t>(), count = text.number<std::size_t>();
      if (!head || !count) return std::nullopt;
      std::vector<PicturePoint> curve;
      for (std::size_t i = 0; i < *count; ++i) {
        const auto x = text.number<double>(), y = text.number<double>();
        if (!x || !y) return std::nullopt;
        curve.push_back({*x, *y});
      }
      if (curve.size() % 3 != 1 || curve.size() < 4) return std::nullopt;
      curves.emplace(std::minmax(*tail, *head), std::move(curve));
    }
  }
  place_specks(specks, height, layout);
  double left = 1e300, right = -1e300;
  for (const PicturePoint& node : layout.nodes) {
    if (node.x < 0) return std::nullopt;
    left = std::min(left, node.x);
    right = std::max(right, node.x);
  }
  for (const auto& [ends, curve] : curves)
    for (const PicturePoint& point : curve) {
      left = std::min(left, point.x);
      right = std::max(right, point.x);
    }
  // A slim graph is not drawn out.
  const double width = std::max(right - left, (highest - lowest) / 3), middle = (left + right) / 2;
  const auto across = [&](double x) { return std::clamp((x - middle) / width + 0.5, 0.0, 1.0); };
  for (PicturePoint& node : layout.nodes) node.x = across(node.x);
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const PicturePoint lo = layout.nodes[graph.lo[arc].value()], hi = layout.nodes[graph.hi[arc].value()];
    if (specks[graph.lo[arc].value()] != kNoSpeck) {
      layout.arcs.push_back(upright_curve(lo, hi, 0));
      continue;
    }
    const auto found = curves.find(std::minmax<std::size_t>(graph.lo[arc].value(), graph.hi[arc].value()));
    if (found == curves.end()) return std::nullopt;
    std::vector<PicturePoint> curve = std::move(found->second);
    curves.erase(found);
    // Dot has both ends of a nearly level arc in one row, so heights do not tell which is which.
    const PicturePoint &low = placed[graph.lo[arc].value()], &high = placed[graph.hi[arc].value()];
    if (distance(curve.front(), high) + distance(curve.back(), low) <
        distance(curve.front(), low) + distance(curve.back(), high))
      std::reverse(curve.begin(), curve.end());
    // An arc rises all the way.
    for (PicturePoint& point : curve)
      point = {across(point.x), std::clamp((point.y - lowest) / (highest - lowest), lo.y, hi.y)};
    curve.front() = lo;
    curve.back() = hi;
    layout.arcs.push_back(std::move(curve));
  }
  return layout;
}

}  // namespace reeb::io
