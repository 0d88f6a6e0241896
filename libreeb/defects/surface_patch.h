// A part of a triangle mesh in memory: the neighbourhood of a loop, with its edges, fans and orientation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/base/vector3.h"
#include "libreeb/graph/settled_node.h"

namespace reeb {

// What a patch is made of. Vertices are numbered from 0; triangles have three different corners, and none is repeated.
struct PatchContent {
  std::vector<VertexId> vertices;  // ascending
  std::vector<Point> positions;
  std::vector<std::uint8_t> whole;  // all triangles of the mesh at this vertex are in the patch
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// THREADS: any number may read one at the same time.
// MEMORY:  about 250 bytes per vertex.
class SurfacePatch {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Edge {
    std::uint32_t a = 0, b = 0;  // a < b
    double length = 0;
  };

  // O(n log n).
  explicit SurfacePatch(PatchContent content);

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(content_.vertices.size()); }
  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(content_.triangles.size()); }
  std::uint32_t edge_count() const { return static_cast<std::uint32_t>(edges_.size()); }

  VertexId vertex(std::uint32_t v) const { return content_.vertices[v]; }
  // The number of a vertex of the mesh; kNone if it is not in the patch.
  std::uint32_t find(VertexId vertex) const;
  const Point& position(std::uint32_t v) const { return content_.positions[v]; }
  bool whole(std::uint32_t v) const { return content_.whole[v] != 0; }
  const std::array<std::uint32_t, 3>& triangle(std::uint32_t t) const { return content_.triangles[t]; }
  const Edge& edge(std::uint32_t e) const { return edges_[e]; }

  // Edge i of a triangle joins corners i and i + 1.
  const std::array<std::uint32_t, 3>& edges_of(std::uint32_t t) const { return triangle_edges_[t]; }
  std::span<const std::uint32_t> triangles_at_edge(std::uint32_t e) const {
    return std::span(edge_triangles_).subspan(edge_first_[e], edge_first_[e + 1] - edge_first_[e]);
  }
  std::span<const std::uint32_t> edges_at(std::uint32_t v) const {
    return std::span(vertex_edges_).subspan(vertex_first_[v], vertex_first_[v + 1] - vertex_first_[v]);
  }
  std::uint32_t edge_between(std::uint32_t a, std::uint32_t b) const;  // kNone if there is none
  // Whether triangles of the mesh at this edge can be missing in the patch.
  bool at_rim(std::uint32_t e) const { return !whole(edges_[e].a) && !whole(edges_[e].b); }

  // Whether a triangle must be turned to be oriented as its connected part of the patch. Parts follow the majority of
  // their triangles. Where a part cannot be oriented, some edges are not consistent.
  bool turned(std::uint32_t t) const { return turned_[t] != 0; }
  // The corners, oriented.
  std::array<std::uint32_t, 3> oriented(std::uint32_t t) const;
  // Two triangles that are oriented alike.
  bool consistent(std::uint32_t e) const;
  // Twice the area, along the normal of the oriented triangle.
  Point normal(std::uint32_t t) const;

 private:
  void make_edges();
  void orient();

  PatchContent content_;
  std::vector<Edge> edges_;
  std::vector<std::array<std::uint32_t, 3>> triangle_edges_;
  std::vector<std::uint32_t> edge_first_, edge_triangles_, vertex_first_, vertex_edges_;
  std::vector<std::uint8_t> turned_;
};

}  // namespace reeb
