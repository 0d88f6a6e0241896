#include "io/plot/skeleton_picture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/drawing/canvas.h"
#include "io/export/line_points.h"
#include "io/plot/graph_layout.h"
#include "io/plot/node_marks.h"
#include "io/plot/specks.h"
#include "io/plot/value_axis.h"
#include "io/text/number_text.h"

namespace reeb::io {
namespace {

using Stop = SkeletonLines::Stop;

constexpr std::uint16_t kHiddenLayers = 2;  // the nearest layer is the surface around the line itself

// The mean over a few neighbours: the buckets at the ends of an arc are cut off.
std::vector<double> smoothed_counts(std::span<const Bucket> buckets) {
  std::vector<double> counts;
  for (const Bucket& bucket : buckets)
    if (bucket.count != 0) counts.push_back(static_cast<double>(bucket.count));
  std::vector<double> result(counts.size());
  constexpr std::ptrdiff_t kReach = 2;
  const auto last = static_cast<std::ptrdiff_t>(counts.size()) - 1;
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    double sum = 0;
    for (std::ptrdiff_t k = -kReach; k <= kReach; ++k)
      sum += counts[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i + k, 0, last))];
    result[static_cast<std::size_t>(i)] = sum / (2 * kReach + 1);
  }
  return result;
}

struct DrawnStop {
  PicturePoint at;
  Rgb color;
  double width = 0;
  bool hidden = false;
};

double width_of(double size) { return 1.6 + 5.4 * size; }

class SkeletonDrawing {
 public:
  SkeletonDrawing(const SkeletonLines& lines, const SkeletonScene& scene) : lines_(lines), scene_(scene) {
    std::size_t at = 0;
    for (const auto& arc : lines.arcs) {
      first_stop_.push_back(at);
      at += arc.size();
    }
  }

  // The stops of an arc in the picture, those that are too close to others left out.
  std::vector<DrawnStop> drawn(std::size_t arc) const {
    std::vector<DrawnStop> result;
    const auto& stops = lines_.arcs[arc];
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const PicturePoint at = scene_.projection.place(stops[i].at);
      if (i > 0 && i + 1 < stops.size() && std::hypot(at.x - result.back().at.x, at.y - result.back().at.y) < 0.8)
        continue;
      result.push_back(
          {at, color_of(arc, stops[i]), std::round(width_of(stops[i].size) * 2) / 2, is_hidden(first_stop_[arc] + i)});
    }
    // A stop that differs from both neighbours is an accident of the sampling.
    for (std::size_t i = 1; i + 1 < result.size(); ++i)
      if (result[i - 1].hidden == result[i + 1].hidden) result[i].hidden = result[i - 1].hidden;
    for (DrawnStop& stop : result)
      if (stop.hidden && stop.color == kInk) stop.color = kPaper;  // on the colours of a surface
    return result;
  }

  // From the farthest arc to the nearest.
  std::vector<std::size_t> order() const {
    std::vector<double> depth;
    for (const auto& arc : lines_.arcs) depth.push_back(scene_.projection.depth(arc[arc.size() / 2].at));
    std::vector<std::size_t> result(lines_.arcs.size());
    std::iota(result.begin(), result.end(), std::size_t{0});
    std::stable_sort(result.begin(), result.end(), [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
    return result;
  }

 private:
  Rgb color_of(std::size_t arc, const Stop& stop) const {
    if (scene_.colors == LineColors::kArcs) return arc_color(arc);
    if (scene_.style == SurfaceStyle::kValue) return kInk;
    constexpr double kSteps = 24;  // neighbours of one colour are one line
    return line_color(std::round(stop.height * kSteps) / kSteps);
  }
  bool is_hidden(std::size_t stop) const { return !scene_.layers.empty() && scene_.layers[stop] >= kHiddenLayers; }

  const SkeletonLines& lines_;
  const SkeletonScene& scene_;
  std::vector<std::size_t> first_stop_;
};

double length_of(std::span<const DrawnStop> stops) {
  double length = 0;
  for (std::size_t i = 1; i < stops.size(); ++i)
    length += std::hypot(stops[i].at.x - stops[i - 1].at.x, stops[i].at.y - stops[i - 1].at.y);
  return length;
}

void append_path(std::string& svg, std::span<const DrawnStop> stops) {
  svg += "<path d=\"M";
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (i > 0) svg += i == 1 ? 'L' : ' ';
    append_point(svg, stops[i].at);
  }
  svg += '"';
}

void append_arc(std::string& svg, std::span<const DrawnStop> stops) {
  svg += "<g class=\"arc\">";
  // What is not hidden has a white rim, which separates lines that cross.
  for (std::size_t i = 0; i + 1 < stops.size();) {
    std::size_t end = i + 1;
    double width = stops[i].width;
    while (end + 1 < stops.size() && stops[end].hidden == stops[i].hidden) width = std::max(width, stops[end++].width);
    if (!stops[i].hidden) {
      append_path(svg, stops.subspan(i, end - i + 1));
      svg += " stroke=\"#fff\" stroke-width=\"";
      append_coordinate(svg, width + 1.8);
      svg += "\"/>";
    }
    i = end;
  }
  for (std::size_t i = 0; i + 1 < stops.size();) {
    std::size_t end = i + 1;
    while (end + 1 < stops.size() && stops[end].hidden == stops[i].hidden && stops[end].width == stops[i].width &&
           stops[end].color == stops[i].color)
      ++end;
    append_path(svg, stops.subspan(i, end - i + 1));
    svg += " stroke=\"" + hex(stops[i].color) + "\" stroke-width=\"";
    append_coordinate(svg, stops[i].width);
    svg += stops[i].hidden ? "\" stroke-linecap=\"butt\" opacity=\"0.35\"/>" : "\"/>";
    i = end;
  }
  svg += "</g>\n";
}

// The bar of colours, from the least value to the greatest.
void append_color_bar(std::string& svg, PicturePoint at, const GraphView& view, const SkeletonScene& scene) {
  const bool of_surface = scene.style == SurfaceStyle::kValue;
  constexpr int kSteps = 40;
  constexpr double kWidth = 200, kHeight = 9;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps;
    svg += "<rect x=\"";
    append_coordinate(svg, at.x + kWidth * i / kSteps);
    svg += "\" y=\"";
    append_coordinate(svg, at.y);
    svg += "\" width=\"";
    append_coordinate(svg, kWidth / kSteps + 0.3);
    svg += "\" height=\"";
    append_coordinate(svg, kHeight);
    svg += "\" fill=\"" + hex(of_surface ? surface_color(t) : line_color(t)) + "\"/>\n";
  }
  const double y = at.y + kHeight + 14;
  const double low = view.graph.nodes.front().value, high = view.graph.nodes.back().value;
  const int digits = digits_for_range(low, high, 4);
  append_text(svg, {at.x, y}, short_number(low, digits), {.size = 11});
  append_text(svg, {at.x + kWidth / 2, y}, "f = " + std::string(view.function), {.size = 11, .anchor = "middle"});
  append_text(svg, {at.x + kWidth, y}, short_number(high, digits), {.size = 11, .anchor = "end"});
}

// How long a round number of units of the mesh is. `at` is its right end.
void append_scale(std::string& svg, PicturePoint at, double pixels_per_unit) {
  if (pixels_per_unit == 0) return;
  const auto lengths = round_values(0, 200 / pixels_per_unit, 2);
  const double length = lengths.size() > 1 ? lengths[1] : 0;
  const double pixels = length * pixels_per_unit;
  if (!(pixels > 5 && pixels < 400)) return;
  svg += "<path stroke=\"#222\" stroke-width=\"1.5\" fill=\"none\" d=\"M";
  append_point(svg, {at.x - pixels, at.y});
  svg += "v8m0,-4H";
  append_coordinate(svg, at.x);
  svg += "m0,-4v8\"/>\n";
  append_text(svg, {at.x, at.y + 23}, short_number(length, 4) + (length == 1 ? " unit of length" : " units of length"),
              {.size = 11, .anchor = "end"});
}

// Lines, and marks at the nodes.
void append_skeleton(std::string& svg, const GraphView& view, const SkeletonLines& lines, const SkeletonScene& scene,
                     std::span<const NodeKind> kinds) {
  const SkeletonDrawing drawing(lines, scene);
  std::vector<double> longest(kinds.size(), 0);                   // arc of each node, in pixels
  const std::vector<std::uint32_t> lone = specks_of(view.graph);  // often many
  constexpr double kLoneShort = 40;
  svg += "<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
  for (const std::size_t arc : drawing.order()) {
    std::vector<DrawnStop> stops = drawing.drawn(arc);
    const double length = length_of(stops);
    if (lines.arcs.size() > 20 && length < kLoneShort && lone[view.graph.lo[arc].value()] != kNoSpeck)
      for (DrawnStop& stop : stops) stop.width = 1;
    for (const NodeId node : {view.graph.lo[arc], view.graph.hi[arc]})
      longest[node.value()] = std::max(longest[node.value()], length);
    append_arc(svg, stops);
  }
  svg += "</g>\n";
  // Where there are many nodes, those at short arcs are points.
  constexpr double kShort = 8;
  std::string marks, specks;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const bool is_speck = kinds.size() > 20 && longest[i] < (lone[i] != kNoSpeck ? kLoneShort : kShort);
    append_node(is_speck ? specks : marks, scene.projection.place(lines.nodes[i]), kinds[i], is_speck ? 1.7 : 4.2);
  }
  svg += "<g stroke=\"#222\" stroke-width=\"0.3\">\n" + specks + "</g>\n<g stroke=\"#222\">\n" + marks + "</g>\n";
}

// The surface, if there is one, with the lines as a part of the image.
Raster lines_as_image(const SkeletonLines& lines, const SkeletonScene& scene) {
  const SkeletonDrawing drawing(lines, scene);
  constexpr double kScale = 1.5;
  Canvas canvas = scene.surface == nullptr
                      ? Canvas(kSkeletonBoxWidth, scene.projection.height(), kScale)
                      : Canvas(*scene.surface, static_cast<double>(scene.surface->width) / kSkeletonBoxWidth);
  const auto inside = [](PicturePoint at) { return PicturePoint{at.x - kSkeletonCorner.x, at.y - kSkeletonCorner.y}; };
  for (const std::size_t arc : drawing.order()) {
    const std::vector<DrawnStop> stops = drawing.drawn(arc);
    for (std::size_t i = 1; i < stops.size(); ++i)
      canvas.line(inside(stops[i - 1].at), inside(stops[i].at), 0.8, stops[i].color);
  }
  return canvas.image();
}

// What is below the skeleton, from `top` on. `kinds`: of the nodes that have marks; none if there are too many.
void append_legends(std::string& svg, double top, const GraphView& view, const SkeletonLines& lines,
                    const SkeletonScene& scene, std::span<const NodeKind> kinds) {
  const bool has_colors =
      !lines.arcs.empty() && (scene.colors == LineColors::kValue || scene.style == SurfaceStyle::kValue);
  if (has_colors) append_color_bar(svg, {20, top + 12}, view, scene);
  double end = 0;
  if (!kinds.empty()) end = append_legend(svg, {has_colors ? 252.0 : 26.0, top + 22}, kinds);
  // The scale is beside a short legend, and below a long one.
  constexpr double kScaleWidth = 230;
  const double scale_top = end > kSkeletonWidth - 24 - kScaleWidth ? top + 33 : top + 10;
  append_scale(svg, {kSkeletonWidth - 24, scale_top}, scene.projection.pixels_per_unit());
  // A line that turns back to its fork looks as if it ended.
  if (!lines.arcs.empty())
    append_text(svg, {20, top + 56},
                std::string("Lines join ") + (view.on_surface ? "points" : "the centres") +
                    (kinds.empty() ? " of contours. There are too many nodes to mark them."
                                   : " of contours; a bend without a mark is not a node."),
                {.size = 11, .color = kGreyInk});
}

}  // namespace

SkeletonLines skeleton_lines(const GraphView& view) {
  const ReebGraph& graph = view.graph;
  const std::vector<double> height = heights(graph);
  SkeletonLines lines;
  lines.nodes.assign(graph.positions.begin(), graph.positions.end());
  const double low = graph.nodes.empty() ? 0 : graph.nodes.front().value;
  const double high = graph.nodes.empty() ? 0 : graph.nodes.back().value;
  const double range = high / 2 - low / 2;
  std::vector<double> sizes;
  std::vector<Point> line;
  std::vector<double> arc_sizes;
  for (std::size_t arc = 0; arc < graph.arc_count(); ++arc) {
    const std::size_t lo = graph.lo[arc].value(), hi = graph.hi[arc].value();
    std::vector<Stop> stops{{lines.nodes[lo], height[lo], 0}};
    if (!view.buckets.empty()) {
      const auto buckets = view.buckets.of(arc);
      if (view.has_spreads)
        find_radii(view, arc, arc_sizes);
      else
        arc_sizes = smoothed_counts(buckets);
      draw_arc(view, arc, line);
      std::size_t next = 0;
      for (const Bucket& bucket : buckets) {
        if (bucket.count == 0) continue;
        const double value = std::ldexp(static_cast<double>(bucket.index) + 0.5, view.bucket_exponent);
        const double share = range > 0 ? (value / 2 - low / 2) / range : 0.5;
        stops.push_back({line[next], std::clamp(share, height[lo], height[hi]), arc_sizes[next]});
        sizes.push_back(arc_sizes[next]);
        ++next;
      }
    }
    stops.push_back({lines.nodes[hi], height[hi], 0});
    stops.front().size = stops[1].size;
    stops.back().size = stops[stops.size() - 2].size;
    lines.arcs.push_back(std::move(stops));
  }
  if (sizes.empty()) return lines;
  // A few large contours, as of the faces of a box, do not make all others thin.
  const auto large = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() - 1) * 97 / 100);
  std::nth_element(sizes.begin(), large, sizes.end());
  for (auto& arc : lines.arcs)
    for (Stop& stop : arc) stop.size = *large > 0 ? std::min(stop.size / *large, 1.0) : 0;
  return lines;
}

std::vector<Point> all_points(const SkeletonLines& lines) {
  std::vector<Point> points;
  for (const auto& arc : lines.arcs)
    for (const Stop& stop : arc) points.push_back(stop.at);
  return points;
}

std::string skeleton_picture(const GraphView& view, const SkeletonLines& lines, const SkeletonScene& scene,
                             const Heading& heading) {
  const double bottom = kSkeletonCorner.y + scene.projection.height() + 16;
  const std::vector<NodeKind> kinds = node_kinds(view.graph);
  std::string svg = begin_svg(kSkeletonWidth, bottom + 66, heading);
  const auto append = [&](const Raster& image) {
    append_image(svg, image, kSkeletonCorner, kSkeletonBoxWidth, scene.projection.height());
  };
  const bool as_lines = lines.arcs.size() <= kMostSkeletonArcs && kinds.size() <= 2 * kMostSkeletonArcs;
  if (as_lines) {
    if (scene.surface != nullptr) append(*scene.surface);
    append_skeleton(svg, view, lines, scene, kinds);
  } else {
    append(lines_as_image(lines, scene));
  }
  append_legends(svg, bottom, view, lines, scene, as_lines ? kinds : std::vector<NodeKind>{});
  return svg + "</svg>\n";
}

}  // namespace reeb::io
