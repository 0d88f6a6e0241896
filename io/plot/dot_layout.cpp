#include "io/plot/dot_layout.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "io/plot/specks.h"

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

double distance(const PicturePoint& a, const PicturePoint& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// The curves that dot drew from one node to another, in either direction.
using Curves = std::multimap<std::pair<std::size_t, std::size_t>, std::vector<PicturePoint>>;

// What dot wrote, in inches.
struct Plain {
  std::vector<PicturePoint> nodes;
  std::vector<bool> has_place;  // of each node
  Curves curves;
  double lowest = 0, highest = 1;  // rows
};

std::optional<std::vector<PicturePoint>> read_curve(PlainText& text) {
  const auto count = text.number<std::size_t>();
  if (!count) return std::nullopt;
  std::vector<PicturePoint> curve;
  for (std::size_t i = 0; i < *count; ++i) {
    const auto x = text.number<double>(), y = text.number<double>();
    if (!x || !y) return std::nullopt;
    curve.push_back({*x, *y});
  }
  if (curve.size() % 3 != 1 || curve.size() < 4) return std::nullopt;
  return curve;
}

// Nothing if the text is not a layout with this number of nodes.
std::optional<Plain> parse_plain(std::string_view written, std::size_t nodes) {
  Plain plain;
  plain.nodes.resize(nodes);
  plain.has_place.assign(nodes, false);
  PlainText text(written);
  while (text.next_line()) {
    const std::string_view item = text.word();
    if (item == "node") {
      const std::string_view name = text.word();
      if (name == "r0" || name == 'r' + std::to_string(kRows - 1)) {
        text.word();
        if (const auto y = text.number<double>()) (name == "r0" ? plain.lowest : plain.highest) = *y;
        continue;
      }
      if (name.starts_with('r')) continue;
      std::size_t node = 0;
      std::from_chars(name.data(), name.data() + name.size(), node);
      const auto x = text.number<double>(), y = text.number<double>();
      if (node >= nodes || !x || !y) return std::nullopt;
      plain.nodes[node] = {*x, *y};
      plain.has_place[node] = true;
    } else if (item == "edge") {
      const auto tail = text.number<std::size_t>();
      if (!tail) continue;  // between rows
      const auto head = text.number<std::size_t>();
      auto curve = read_curve(text);
      if (!head || !curve) return std::nullopt;
      plain.curves.emplace(std::minmax(*tail, *head), std::move(*curve));
    }
  }
  return plain;
}

// Maps x in inches to the width of the picture.
struct Across {
  double middle = 0, width = 1;

  double operator()(double x) const { return std::clamp((x - middle) / width + 0.5, 0.0, 1.0); }
};

Across across_of(const Plain& plain) {
  double left = 1e300, right = -1e300;
  const auto add = [&](double x) {
    left = std::min(left, x);
    right = std::max(right, x);
  };
  for (std::size_t i = 0; i < plain.nodes.size(); ++i)
    if (plain.has_place[i]) add(plain.nodes[i].x);
  for (const auto& [ends, curve] : plain.curves)
    for (const PicturePoint& point : curve) add(point.x);
  if (left > right) return {};
  // A slim graph is not drawn out.
  return {(left + right) / 2, std::max(right - left, (plain.highest - plain.lowest) / 3)};
}

// From the lower node to the upper one, rising all the way. Takes the curve that dot drew; nothing if there is none.
std::optional<std::vector<PicturePoint>> take_curve(Plain& plain, const Across& across, const GraphLayout& layout,
                                                    std::size_t lo, std::size_t hi) {
  const auto found = plain.curves.find(std::minmax(lo, hi));
  if (found == plain.curves.end()) return std::nullopt;
  std::vector<PicturePoint> curve = std::move(found->second);
  plain.curves.erase(found);
  // Dot has both ends of a nearly level arc in one row, so heights do not tell which is which.
  const PicturePoint &low = plain.nodes[lo], &high = plain.nodes[hi];
  if (distance(curve.front(), high) + distance(curve.back(), low) <
      distance(curve.front(), low) + distance(curve.back(), high))
    std::reverse(curve.begin(), curve.end());
  for (PicturePoint& point : curve)
    point = {across(point.x), std::clamp((point.y - plain.lowest) / (plain.highest - plain.lowest), layout.nodes[lo].y,
                                         layout.nodes[hi].y)};
  curve.front() = layout.nodes[lo];
  curve.back() = layout.nodes[hi];
  return curve;
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

std::optional<GraphLayout> read_dot_layout(const ReebGraph& graph, std::string_view written) {
  std::optional<Plain> plain = parse_plain(written, graph.node_count());
  if (!plain) return std::nullopt;
  const std::vector<double> height = heights(graph);
  const std::vector<std::uint32_t> specks = specks_of(graph);
  const Across across = across_of(*plain);
  GraphLayout layout;
  for (std::size_t i = 0; i < height.size(); ++i) {
    if (specks[i] == kNoSpeck && !plain->has_place[i]) return std::nullopt;
    layout.nodes.push_back({across(plain->nodes[i].x), height[i]});
  }
  layout.arcs.resize(graph.arc_count());
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const std::size_t lo = graph.lo[arc].value(), hi = graph.hi[arc].value();
    if (specks[lo] != kNoSpeck) continue;
    auto curve = take_curve(*plain, across, layout, lo, hi);
    if (!curve) return std::nullopt;
    layout.arcs[arc] = std::move(*curve);
  }
  place_specks(graph, specks, layout);
  return layout;
}

}  // namespace reeb::io
