// The part of a surface that is not finished yet, while its triangles stream by, and what was counted so far.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/containers/recycling_array.h"
#include "ooc/census/first_places.h"
#include "ooc/census/live_sets.h"
#include "ooc/census/mesh_census.h"

namespace reeb::ooc {

// Everything about a vertex, an edge or a triangle is counted from the triangles around a vertex that is finished. So
// an edge is counted at the first of its ends that is finished, and a triangle at the first of its corners.
//
// MEMORY: 56 bytes for each vertex that is unfinished or next to one, 32 for each triangle with an unfinished corner,
//         and the sets that meet there.
// TIME: O(1) for a triangle, O(n log n) for a vertex of n triangles where these are not two at each edge.
class LiveSurface {
 public:
  using Slot = std::uint32_t;  // of a vertex, until it is finished

  Slot add_vertex(VertexId id, const Point& position);
  // Corners can be equal.
  void add_triangle(Slot a, Slot b, Slot c);
  void add_edge(Slot a, Slot b);
  void add_point(Slot a) { vertices_[a].used = true; }
  // From now on only components are counted: with a cell the mesh is not a surface.
  void count_components_only() { surface_ = false; }
  void add_cell(std::span<const Slot> corners) {
    for (const Slot corner : corners) connect(corners[0], corner);
  }
  // No later simplex has this vertex.
  void finish(Slot v);

  std::uint64_t memory_bytes() const;
  // REQUIRES: all vertices are finished.
  MeshCensus result() const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Vertex {
    VertexId id;
    Point position;
    std::uint32_t first_corner;  // of the list of its triangles: 4 * triangle + corner
    std::uint32_t triangles;     // that name it and are held
    std::uint32_t component;     // of components_
    std::uint32_t boundary;      // of boundaries_
    std::uint32_t number;        // in neighbours_, while a vertex next to it is examined
    bool finished, used;
    std::uint32_t& next_free() { return first_corner; }
  };

  // An edge of no listed triangle has the form (a, b, b), and is in the lists of a and b.
  struct Triangle {
    std::array<Slot, 3> corners;
    std::array<std::uint32_t, 3> next;  // in the list of each corner
    std::uint32_t side;                 // of sides_
    std::uint8_t unfinished;            // corners
    bool flipped;                       // relative to that number of sides_
    std::uint32_t& next_free() { return side; }
    bool is_edge() const { return corners[1] == corners[2]; }
    std::size_t corner_count() const { return is_edge() ? 2 : 3; }
  };

  struct Component {
    std::uint64_t triangles, vertices;
    VertexId lowest;
    Point position;
    void join(const Component& other);
  };
  // A sum of lengths with 44 bits each, in two parts of 22 bits. The sum of each part is exact unless lengths differ by
  // many powers of two, so the result does not depend on the order of adding.
  struct Length {
    double coarse, fine;
    static Length of(double length);
    void join(const Length& other) {
      coarse += other.coarse;
      fine += other.fine;
    }
  };
  struct Boundary {
    std::uint64_t edges;
    Length length;
    Point min, max;
    VertexId lowest;
    Point position;
    void join(const Boundary& other);
  };
  struct Side {
    void join(const Side&) {}
  };

  // A triangle (v, x, y) around v, as it is turned.
  struct Wing {
    Slot x, y;
    std::uint32_t triangle;
  };
  // A vertex next to v, and its wings, if there are at most two.
  struct Neighbour {
    Slot vertex;
    std::uint32_t first, second;
  };
  // Distinct triangles around v, or an edge of no listed triangle if lo == hi.
  struct Face {
    Slot lo, hi;
    std::uint32_t triangle;  // of its copies, the one with the lowest number: the same at each corner
    bool forward;            // whether this is (v, lo, hi)
  };

  void connect(Slot a, Slot b);
  void hold_triangle(Slot a, Slot b, Slot c);
  void gather_wings(Slot v);
  void note_neighbour(Slot w, std::uint32_t wing);
  bool is_plain() const;
  void examine_plain(Slot v);
  bool is_one_link() const;
  void examine_any(Slot v);
  void list_faces(Slot v);
  void examine_faces(Slot v);
  void count_boundary_edge(Slot v, Slot w);
  void count_inner_edge(Slot v, Slot w, Slot x, Slot y);
  void join_sides(std::uint32_t t, std::uint32_t u, bool opposite);
  void end_component(const Component& component);
  void end_boundary(const Boundary& boundary);
  void release_triangles(Slot v);
  CensusPlace place_of(VertexId id, const Point& position) const { return {.vertices = {id}, .position = position}; }
  Point mean(std::span<const Slot> slots) const;

  RecyclingArray<Vertex> vertices_;
  RecyclingArray<Triangle> triangles_;
  LiveSets<Component> components_;
  LiveSets<Boundary> boundaries_;
  LiveSets<Side> sides_;
  bool surface_ = true;

  // Of the vertex that is examined.
  std::vector<Wing> wings_;
  std::vector<Neighbour> neighbours_;
  bool crowded_ = false;  // a neighbour has more than two wings, or there is an edge of no listed triangle
  std::vector<Face> faces_;
  std::vector<std::pair<Slot, std::uint32_t>> sides_of_faces_;  // a neighbour and a face at it, or kNone

  MeshCensus counts_;
  std::uint64_t edges_ = 0, distinct_triangles_ = 0, surface_components_ = 0;
  bool oriented_ = true, orientable_ = true;
  FirstPlaces nonmanifold_edges_, nonmanifold_vertices_, degenerate_, duplicates_, folded_;
};

}  // namespace reeb::ooc
