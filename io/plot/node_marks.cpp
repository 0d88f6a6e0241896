#include "io/plot/node_marks.h"

#include <algorithm>
#include <array>
#include <utility>

#include "libreeb/base/count_text.h"

namespace reeb::io {

std::vector<NodeKind> node_kinds(const ReebGraph& graph) {
  const Degrees degree = degrees(graph);
  std::vector<NodeKind> kinds(graph.node_count());
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (degree.down[i] == 0)
      kinds[i] = degree.up[i] == 0 ? NodeKind::kIsolated : NodeKind::kMinimum;
    else
      kinds[i] = degree.up[i] == 0 ? NodeKind::kMaximum : NodeKind::kFork;
  }
  return kinds;
}

Rgb node_color(NodeKind kind) {
  constexpr std::array<Rgb, 4> kColors = {kInk, kBlue, kVermilion, kPaper};
  return kColors[static_cast<std::size_t>(kind)];
}

void append_node(std::string& svg, PicturePoint at, NodeKind kind, double radius, std::string_view name) {
  const auto corner = [&](double x, double y) { append_point(svg, {at.x + x * radius, at.y + y * radius}); };
  if (kind == NodeKind::kFork) {
    svg += "<circle class=\"" + std::string(name) + "\" cx=\"";
    append_coordinate(svg, at.x);
    svg += "\" cy=\"";
    append_coordinate(svg, at.y);
    svg += "\" r=\"";
    append_coordinate(svg, radius, 2);
    svg += "\" fill=\"#fff\"/>\n";
    return;
  }
  svg += "<path class=\"" + std::string(name) + "\" d=\"M";
  const double side = kind == NodeKind::kMinimum ? 1 : -1;  // of the tip
  if (kind == NodeKind::kIsolated) {
    corner(-0.9, -0.9);
    svg += 'L';
    corner(0.9, -0.9);
    svg += 'L';
    corner(0.9, 0.9);
    svg += 'L';
    corner(-0.9, 0.9);
  } else {
    corner(-1.1, -0.75 * side);
    svg += 'L';
    corner(1.1, -0.75 * side);
    svg += 'L';
    corner(0, 1.2 * side);
  }
  svg += "z\" fill=\"" + hex(node_color(kind)) + "\"/>\n";
}

double append_legend(std::string& svg, PicturePoint at, std::span<const NodeKind> kinds) {
  constexpr std::array<std::pair<NodeKind, const char*>, 4> kNouns = {{{NodeKind::kMinimum, "minimum"},
                                                                       {NodeKind::kMaximum, "maximum"},
                                                                       {NodeKind::kFork, "fork"},
                                                                       {NodeKind::kIsolated, "isolated node"}}};
  svg += "<g stroke=\"#222\">\n";
  std::string texts;
  for (const auto& [kind, noun] : kNouns) {
    const auto count = static_cast<std::uint64_t>(std::count(kinds.begin(), kinds.end(), kind));
    if (count == 0) continue;
    std::string text = count_of(count, noun);
    if (count > 1 && kind != NodeKind::kFork && kind != NodeKind::kIsolated)  // minima, maxima
      text = with_commas(count) + (kind == NodeKind::kMinimum ? " minima" : " maxima");
    append_node(svg, {at.x, at.y - 4}, kind, 4.5, "key");
    append_text(texts, {at.x + 10, at.y}, text, {.size = 12});
    at.x += 34 + 7.2 * static_cast<double>(text.size());
  }
  svg += "</g>\n" + texts;
  return at.x;
}

}  // namespace reeb::io
