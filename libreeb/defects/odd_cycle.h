// The shortest closed path along edges that crosses a curve an odd number of times.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "libreeb/defects/surface_patch.h"

namespace reeb {

// A closed path along edges, by its vertices; each is joined with the next, and the last with the first.
struct ClosedPath {
  std::vector<std::uint32_t> vertices;
  double length = std::numeric_limits<double>::infinity();
  bool exists() const { return !vertices.empty(); }
};

// For each vertex: 1 if it is whole, and each of its edges has two triangles, oriented alike.
std::vector<std::uint8_t> inner_vertices(const SurfacePatch& patch);
std::vector<std::uint8_t> whole_vertices(const SurfacePatch& patch);

// For each edge: 1 if it crosses the curve, an odd number of times. In each triangle an even number of edges does,
// unless one is barred: no path may use that.
using Crossings = std::vector<std::uint8_t>;
inline constexpr std::uint8_t kBarred = 2;

// The shortest closed path through these vertices (1: allowed) that uses an odd number of crossing edges; no path if
// there is none. It is simple, since an odd path that met itself would contain a shorter one. `gates` are vertices of
// which every such path has one. Of gates that are near each other, compared with the length of the path, not all are
// searched: it can be a few per cent longer than the shortest. TIME: some 20 searches in the patch, each of which ends
// where a path would be longer than the best so far.
// Those longer than four fifths of `longest` can be missed.
ClosedPath shortest_odd_cycle(const SurfacePatch& patch, const Crossings& crossings,
                              std::span<const std::uint32_t> gates, std::span<const std::uint8_t> allowed,
                              double longest);

// The shortest path that crosses the curve an odd number of times and leaves the patch at both ends: all of its
// vertices but the first and the last are whole. No path if there is none. TIME: one search.
ClosedPath shortest_odd_arc(const SurfacePatch& patch, const Crossings& crossings);

// The edges at a vertex, counterclockwise as seen along the normals of the oriented triangles. Empty if its triangles
// are not one closed, consistently oriented fan.
std::vector<std::uint32_t> fan_of(const SurfacePatch& patch, std::uint32_t vertex);

// The edges that leave the path to its left. Nothing if the path meets a boundary, or if the patch is not an oriented
// manifold at one of its vertices.
// REQUIRES: the path is simple, and its vertices are whole.
std::optional<Crossings> left_of(const SurfacePatch& patch, const ClosedPath& path);
// The same for a path that is not closed: the edges at its vertices but the first and the last.
std::optional<Crossings> left_of_arc(const SurfacePatch& patch, const ClosedPath& arc);

// Whether two curves in the patch together bound a part of it.
// REQUIRES: no edge is barred.
bool bound_together(const SurfacePatch& patch, const Crossings& one, const Crossings& other);

}  // namespace reeb
