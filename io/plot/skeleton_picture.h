// A graph in the shape of its mesh: lines over the image of the surface.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/drawing/surface_raster.h"
#include "io/drawing/svg_text.h"
#include "io/export/graph_export.h"
#include "io/plot/view.h"

namespace reeb::io {

// The arcs of a graph as lines in space.
struct SkeletonLines {
  struct Stop {
    Point at{};
    double height = 0;  // share of the range of the function below it
    double size = 0;    // of the contour, from 0 to 1: as its radius says, or its number of vertices
  };
  std::vector<std::vector<Stop>> arcs;
  std::vector<Point> nodes;
};
// Along the buckets of arcs, or straight without them. Sizes are radii if they are known. REQUIRES: nodes have
// positions.
SkeletonLines skeleton_lines(const GraphView& view);

// All points of the lines.
std::vector<Point> all_points(const SkeletonLines& lines);

enum class LineColors { kValue, kArcs };

// What the picture of a skeleton consists of, apart from the graph. The picture is kSkeletonWidth wide and has room for
// headings and legends above and below the box of the projection, which begins at kSkeletonCorner.
inline constexpr double kSkeletonWidth = 800, kSkeletonBoxWidth = 760, kSkeletonMostHeight = 640;
inline constexpr PicturePoint kSkeletonCorner{20, kHeadingHeight + 12};
struct SkeletonScene {
  const Projection& projection;
  const Raster* surface = nullptr;  // of the box
  SurfaceStyle style = SurfaceStyle::kNone;
  LineColors colors = LineColors::kValue;
  std::span<const std::uint16_t> layers;  // of the surface, in front of all_points(); empty: none
};

// Up to this many arcs are lines (class "arc"), and nodes marks (class "node"); more become part of the image.
inline constexpr std::size_t kMostSkeletonArcs = 3000;

std::string skeleton_picture(const GraphView& view, const SkeletonLines& lines, const SkeletonScene& scene,
                             const Heading& heading);

}  // namespace reeb::io
