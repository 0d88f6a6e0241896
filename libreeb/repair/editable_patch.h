// A part of a triangle mesh whose triangles can be removed, restored and added.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/graph/settled_node.h"
#include "libreeb/repair/triangle_cells.h"
#include "libreeb/repair/triangle_crossing.h"

namespace reeb {

class EditablePatch {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::uint64_t kAdded = ~std::uint64_t{0};

  using Corners = std::array<std::uint32_t, 3>;

  struct Vertex {
    VertexId id;  // of the mesh; none() if it was added
    Point position{};
    bool whole = false;                    // all triangles of the mesh at this vertex are in the patch
    bool used_elsewhere = false;           // by something that stays whatever is done to triangles
    Corners parents{kNone, kNone, kNone};  // of an added vertex: it has the mean of their values
  };
  struct Triangle {
    Corners corners{};
    std::uint64_t id = kAdded;  // its place in the mesh
    bool there = true;
  };

  // Two vertices that are joined apart from the triangles: by one that repeats a corner, or by an edge of the mesh.
  struct Line {
    std::uint32_t a = 0, b = 0;
    std::uint64_t id = kAdded;  // the place of the triangle; kAdded for an edge
  };

  std::uint32_t add_vertex(const Vertex& vertex);
  // Three different corners. A repetition is kept with the first one: both are there, or none.
  void add_triangle(const Corners& corners, std::uint64_t id);
  void add_line(const Line& line) { lines_.push_back(line); }
  // A triangle that is not in the patch, but that nothing new may cross. Corners outside the patch have numbers from
  // kOutside on.
  static constexpr std::uint32_t kOutside = kNone - 3;
  void add_obstacle(const PlacedTriangle& triangle) { obstacles_.push_back(triangle); }
  const std::vector<PlacedTriangle>& obstacles() const { return obstacles_; }
  // Returns its number.
  std::uint32_t add_new(const Corners& corners);
  void remove(std::uint32_t t) { triangles_[t].there = false; }
  void restore(std::uint32_t t) { triangles_[t].there = true; }
  // Removes the last ones that were added, down to these numbers of them.
  void take_back(std::size_t vertices, std::size_t triangles);

  PlacedTriangle placed(std::uint32_t t) const {
    const Corners& c = triangles_[t].corners;
    return {c, {position(c[0]), position(c[1]), position(c[2])}};
  }
  // Which triangles there are, to go back to.
  struct State {
    std::size_t vertices = 0;
    std::vector<bool> there;
  };
  State state() const;
  void go_back(const State& before);

  // Where all triangles are, with those that were removed. TIME: proportional to those added since the last call.
  const TriangleCells& cells();

  std::size_t vertex_count() const { return vertices_.size(); }
  std::size_t triangle_count() const { return triangles_.size(); }
  const Vertex& vertex(std::uint32_t v) const { return vertices_[v]; }
  const Point& position(std::uint32_t v) const { return vertices_[v].position; }
  const Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
  // Repetitions: a triangle, and the place of another one with the same corners.
  const std::vector<std::pair<std::uint32_t, std::uint64_t>>& repetitions() const { return repetitions_; }

  const std::vector<Line>& lines() const { return lines_; }
  // Whether it was along an edge of triangles of the mesh, and none is left there.
  bool lies_bare(const Line& line) const;

  // Those at a vertex, also the ones that are not there.
  std::span<const std::uint32_t> all_at(std::uint32_t v) const { return at_[v]; }
  template <class Visit>
  void for_each_at(std::uint32_t v, const Visit& visit) const {
    for (const std::uint32_t t : at_[v])
      if (triangles_[t].there) visit(t);
  }
  template <class Visit>
  void for_each_at_edge(std::uint32_t a, std::uint32_t b, const Visit& visit) const {
    for_each_at(a, [&](std::uint32_t t) {
      if (has_corner(t, b)) visit(t);
    });
  }
  bool has_corner(std::uint32_t t, std::uint32_t v) const {
    const Corners& c = triangles_[t].corners;
    return c[0] == v || c[1] == v || c[2] == v;
  }
  bool is_used(std::uint32_t v) const;
  bool has_edge(std::uint32_t a, std::uint32_t b) const;
  std::size_t triangles_at_edge(std::uint32_t a, std::uint32_t b) const;
  // The triangle on the other side of an edge that has two; else kNone.
  std::uint32_t across(std::uint32_t t, std::uint32_t a, std::uint32_t b) const;
  std::uint32_t third_corner(std::uint32_t t, std::uint32_t a, std::uint32_t b) const;
  // Whether the triangle has a before b.
  bool runs_along(std::uint32_t t, std::uint32_t a, std::uint32_t b) const;
  // Whether the triangles at the vertex are one closed fan, with two of them at each edge.
  bool is_closed_fan(std::uint32_t v) const;

 private:
  std::uint32_t append(const Triangle& triangle);

  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> at_;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> repetitions_;
  std::vector<Line> lines_;
  std::vector<PlacedTriangle> obstacles_;
  TriangleCells cells_;  // of the first triangles
};

}  // namespace reeb
