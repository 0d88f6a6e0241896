// The points and lines of a graph in space, in the order in which all formats number them: first the nodes, then for
// each arc one point per non-empty bucket, from below.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/export/arc_line.h"
#include "io/export/graph_export.h"

namespace reeb::io {

inline std::array<double, 3> node_position(const ReebGraph& graph, std::size_t node) {
  if (graph.positions.empty()) return {0, 0, graph.nodes[node].value};
  return graph.positions[node];
}

// Calls visit(bucket) for the points along an arc.
template <class Visit>
void for_each_inner_point(const GraphView& view, std::size_t arc, const Visit& visit) {
  if (view.buckets.empty()) return;
  for (const Bucket& bucket : view.buckets.of(arc))
    if (bucket.count != 0) visit(bucket);
}

inline std::uint64_t inner_points(const GraphView& view, std::size_t arc) {
  std::uint64_t count = 0;
  for_each_inner_point(view, arc, [&](const Bucket&) { ++count; });
  return count;
}

inline std::uint64_t all_points(const GraphView& view) {
  std::uint64_t count = view.graph.node_count();
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc) count += inner_points(view, arc);
  return count;
}

// Replaces `radii` by those of the points between the nodes of an arc. REQUIRES: view.has_spreads.
inline void find_radii(const GraphView& view, std::size_t arc, std::vector<double>& radii) {
  if (view.on_surface) return find_radii(view.buckets.of(arc), radii);
  const auto end = [&](NodeId node) { return std::ldexp(view.graph.nodes[node.value()].value, -view.bucket_exponent); };
  find_line_radii(end(view.graph.lo[arc]), view.buckets.of(arc), end(view.graph.hi[arc]), radii);
}

// Replaces `line` by the points between the nodes of an arc.
inline void draw_arc(const GraphView& view, std::size_t arc, std::vector<std::array<double, 3>>& line) {
  if (view.on_surface) {
    line.clear();
    for_each_inner_point(view, arc, [&](const Bucket& bucket) {
      const RimPoint rim = rim_of(bucket);
      line.push_back(bucket.count == 1 ? bucket.mean : std::array<double, 3>{rim[0], rim[1], rim[2]});
    });
    return;
  }
  draw_arc(node_position(view.graph, view.graph.lo[arc].value()), view.buckets.of(arc),
           node_position(view.graph, view.graph.hi[arc].value()), line);
}

template <class Visit>
void for_each_node_point(const GraphView& view, const Visit& visit) {
  for (std::size_t i = 0; i < view.graph.node_count(); ++i) visit(node_position(view.graph, i));
}

template <class Visit>
void for_each_point(const GraphView& view, const Visit& visit) {
  for_each_node_point(view, visit);
  if (view.buckets.empty()) return;
  std::vector<std::array<double, 3>> line;
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc) {
    draw_arc(view, arc, line);
    for (const auto& point : line) visit(point);
  }
}

// Calls begin(points), point(index) for each, end(), for each arc.
template <class Begin, class At, class End>
void for_each_line(const GraphView& view, const Begin& begin, const At& at, const End& end) {
  std::uint64_t next = view.graph.node_count();
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc) {
    const std::uint64_t inner = inner_points(view, arc);
    begin(inner + 2);
    at(view.graph.lo[arc].value());
    for (std::uint64_t i = 0; i < inner; ++i) at(next++);
    at(view.graph.hi[arc].value());
    end();
  }
}

// Calls visit(a, b) for each piece of each line.
template <class Visit>
void for_each_segment(const GraphView& view, const Visit& visit) {
  std::uint64_t before = 0;
  bool first = true;
  for_each_line(
      view, [&](std::uint64_t) { first = true; },
      [&](std::uint64_t i) {
        if (!first) visit(before, i);
        first = false;
        before = i;
      },
      [] {});
}

// The radii of all points: of a node the mean of those of the buckets next to it. Zeros if they are not known.
// MEMORY: 12 bytes per node, 8 per point.
inline std::vector<double> all_radii(const GraphView& view) {
  std::vector<double> radii(view.graph.node_count()), of_arc;
  if (!view.has_spreads) {
    radii.resize(all_points(view));
    return radii;
  }
  std::vector<std::uint32_t> neighbours(radii.size());
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc) {
    find_radii(view.buckets.of(arc), of_arc);
    if (of_arc.empty()) continue;
    const auto add = [&](NodeId node, double radius) {
      double& mean = radii[node.value()];
      mean += (radius - mean) / ++neighbours[node.value()];
    };
    add(view.graph.lo[arc], of_arc.front());
    add(view.graph.hi[arc], of_arc.back());
    find_radii(view, arc, of_arc);
    radii.insert(radii.end(), of_arc.begin(), of_arc.end());
  }
  return radii;
}

}  // namespace reeb::io
