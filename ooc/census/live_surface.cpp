#include "ooc/census/live_surface.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/vector3.h"
#include "libreeb/containers/union_find.h"

namespace reeb::ooc {
namespace {

// Whether the triangles (v, w, x) and (w, v, y) have normals that are more than 170 degrees apart. A triangle without
// area has no normal.
bool is_folded(const Point& v, const Point& w, const Point& x, const Point& y) {
  constexpr double kCosineSquared = 0.96984631039295419;  // of 10 degrees
  const Point edge = w - v, a = cross(edge, x - v), b = cross(edge, y - v);
  const double both = dot(a, b);
  return both > 0 && both * both > kCosineSquared * dot(a, a) * dot(b, b);
}

template <class Extent>
void join_lowest(Extent& here, const Extent& other) {
  if (!(other.lowest < here.lowest)) return;
  here.lowest = other.lowest;
  here.position = other.position;
}

std::string why_no_genus(const MeshCensus& census, bool has_triangles) {
  if (!has_triangles) return "it has no triangles";
  if (census.nonmanifold_edges.count != 0)
    return "it has " + count_of(census.nonmanifold_edges.count, "non-manifold edge");
  if (census.loose_edges != 0) return "it has " + count_of(census.loose_edges, "edge") + " of no triangle";
  if (census.nonmanifold_vertices.count != 0)
    return "it has " + count_of(census.nonmanifold_vertices.count, "non-manifold vertex");
  return census.orientable.value_or(true) ? "" : "it is not orientable";
}

// Squares can be beyond double where the length is not.
double length_between(const Point& a, const Point& b) {
  const double length = distance(a, b);
  if (std::isfinite(length)) return length;
  const Point step = a - b;
  return std::hypot(std::hypot(step[0], step[1]), step[2]);  // std::hypot of three gives NaN if one is infinite
}

}  // namespace

void LiveSurface::Component::join(const Component& other) {
  triangles += other.triangles;
  vertices += other.vertices;
  join_lowest(*this, other);
}

LiveSurface::Length LiveSurface::Length::of(double length) {
  constexpr int kBits = 22;
  if (!std::isfinite(length)) return {length, 0};
  int exponent = 0;
  std::frexp(length, &exponent);
  const double coarse = std::ldexp(std::floor(std::ldexp(length, kBits - exponent)), exponent - kBits);
  const double fine = std::ldexp(std::round(std::ldexp(length - coarse, 2 * kBits - exponent)), exponent - 2 * kBits);
  return {coarse, fine};
}

void LiveSurface::Boundary::join(const Boundary& other) {
  edges += other.edges;
  length.join(other.length);
  for (std::size_t k = 0; k < 3; ++k) {
    min[k] = std::min(min[k], other.min[k]);
    max[k] = std::max(max[k], other.max[k]);
  }
  join_lowest(*this, other);
}

LiveSurface::Slot LiveSurface::add_vertex(VertexId id, const Point& position) {
  const Slot slot = vertices_.take();
  vertices_[slot] = {.id = id,
                     .position = position,
                     .first_corner = kNone,
                     .triangles = 0,
                     .component = kNone,
                     .boundary = kNone,
                     .number = kNone,
                     .finished = false,
                     .used = false};
  return slot;
}

void LiveSurface::connect(Slot a, Slot b) {
  Vertex &here = vertices_[a], &there = vertices_[b];
  here.used = there.used = true;
  components_.bind(here.component, there.component, {0, 0, here.id, here.position});
}

void LiveSurface::add_triangle(Slot a, Slot b, Slot c) {
  connect(a, b);
  connect(a, c);
  if (!surface_) return;
  if (a != b && b != c && a != c) {
    ++components_.value(vertices_[a].component).triangles;
    return hold_triangle(a, b, c);
  }
  const Slot other = b != a ? b : c;
  const std::array<Slot, 2> corners{a, other};
  const VertexId first = vertices_[a].id;
  degenerate_.add(other == a ? FirstPlaces::ascending(first) : FirstPlaces::ascending(first, vertices_[other].id),
                  mean(corners));
  if (other != a) hold_triangle(a, other, other);
}

void LiveSurface::add_edge(Slot a, Slot b) {
  connect(a, b);
  if (surface_ && a != b) hold_triangle(a, b, b);
}

void LiveSurface::hold_triangle(Slot a, Slot b, Slot c) {
  constexpr std::uint32_t kMostTriangles = 1u << 30;
  const std::uint32_t t = triangles_.take();
  if (t >= kMostTriangles)
    throw Error(ErrorKind::kResource, "more than 2^30 triangles are unfinished at once",
                "put the mesh in another order first: reeb convert MESH OUT.smb --order hilbert");
  Triangle& triangle = triangles_[t];
  triangle = {.corners = {a, b, c}, .next = {kNone, kNone, kNone}, .side = kNone, .unfinished = 0, .flipped = false};
  const auto corners = static_cast<std::uint8_t>(triangle.corner_count());
  triangle.unfinished = corners;
  for (std::uint32_t k = 0; k < corners; ++k) {
    Vertex& vertex = vertices_[triangle.corners[k]];
    triangle.next[k] = std::exchange(vertex.first_corner, 4 * t + k);
    ++vertex.triangles;
  }
}

void LiveSurface::finish(Slot v) {
  Vertex& vertex = vertices_[v];
  vertex.finished = true;
  ++counts_.vertices;
  counts_.unused_vertices += vertex.used ? 0 : 1;
  if (surface_ && vertex.first_corner != kNone) {
    gather_wings(v);
    if (is_plain())
      examine_plain(v);
    else
      examine_any(v);
    for (const Neighbour& neighbour : neighbours_) vertices_[neighbour.vertex].number = kNone;
  }
  if (vertex.boundary != kNone)
    boundaries_.release(vertex.boundary, [this](const Boundary& boundary) { end_boundary(boundary); });
  const Component alone{0, 1, vertex.id, vertex.position};
  if (vertex.component == kNone) {
    end_component(alone);
  } else {
    components_.value(vertex.component).join(alone);
    components_.release(vertex.component, [this](const Component& component) { end_component(component); });
  }
  release_triangles(v);
}

// A triangle that all its corners have seen is forgotten, and so is a vertex that is finished, once no triangle needs
// its position.
void LiveSurface::release_triangles(Slot v) {
  std::uint32_t corner = vertices_[v].first_corner;
  if (corner == kNone) return vertices_.free(v);
  while (corner != kNone) {
    const std::uint32_t t = corner / 4;
    Triangle& triangle = triangles_[t];
    corner = triangle.next[corner % 4];
    if (--triangle.unfinished != 0) continue;
    for (std::size_t k = 0; k < triangle.corner_count(); ++k)
      if (--vertices_[triangle.corners[k]].triangles == 0) vertices_.free(triangle.corners[k]);
    if (triangle.side != kNone) sides_.release(triangle.side, [](const Side&) {});
    triangles_.free(t);
  }
}

// ---- the star of a vertex

void LiveSurface::gather_wings(Slot v) {
  wings_.clear();
  neighbours_.clear();
  crowded_ = false;
  for (std::uint32_t corner = vertices_[v].first_corner; corner != kNone;) {
    const Triangle& triangle = triangles_[corner / 4];
    const std::uint32_t k = corner % 4;
    corner = triangle.next[k];
    const auto wing = static_cast<std::uint32_t>(wings_.size());
    const auto t = static_cast<std::uint32_t>(&triangle - &triangles_[0]);
    if (triangle.is_edge()) {
      crowded_ = true;
      const Slot other = triangle.corners[1 - k];
      wings_.push_back({other, other, t});
      note_neighbour(other, wing);
    } else {
      const Slot x = triangle.corners[k == 2 ? 0 : k + 1], y = triangle.corners[k == 0 ? 2 : k - 1];
      wings_.push_back({x, y, t});
      note_neighbour(x, wing);
      note_neighbour(y, wing);
    }
  }
}

void LiveSurface::note_neighbour(Slot w, std::uint32_t wing) {
  std::uint32_t& number = vertices_[w].number;
  if (number == kNone) {
    number = static_cast<std::uint32_t>(neighbours_.size());
    neighbours_.push_back({w, wing, kNone});
  } else if (Neighbour& neighbour = neighbours_[number]; neighbour.second == kNone) {
    neighbour.second = wing;
  } else {
    crowded_ = true;
  }
}

// Whether all triangles around the vertex are distinct, with at most two at each edge.
bool LiveSurface::is_plain() const {
  if (crowded_) return false;
  return std::ranges::all_of(neighbours_, [this](const Neighbour& neighbour) {
    if (neighbour.second == kNone) return true;
    const Wing &a = wings_[neighbour.first], &b = wings_[neighbour.second];
    return (a.x == neighbour.vertex ? a.y : a.x) != (b.x == neighbour.vertex ? b.y : b.x);
  });
}

void LiveSurface::examine_plain(Slot v) {
  for (const Wing& wing : wings_)
    distinct_triangles_ += !vertices_[wing.x].finished && !vertices_[wing.y].finished ? 1u : 0u;
  for (const Neighbour& neighbour : neighbours_) {
    const Slot w = neighbour.vertex;
    if (vertices_[w].finished) continue;
    ++edges_;
    if (neighbour.second == kNone) {
      count_boundary_edge(v, w);
      continue;
    }
    const Wing &a = wings_[neighbour.first], &b = wings_[neighbour.second];
    const bool agree = (a.x == w) != (b.x == w);
    oriented_ = oriented_ && agree;
    join_sides(a.triangle, b.triangle, !agree);
    count_inner_edge(v, w, a.x == w ? a.y : a.x, b.x == w ? b.y : b.x);
  }
  if (!is_one_link()) nonmanifold_vertices_.add(FirstPlaces::ascending(vertices_[v].id), vertices_[v].position);
}

// Whether the link of a vertex that is plain is one path or one cycle: whether a walk along it passes all triangles.
bool LiveSurface::is_one_link() const {
  const auto end = std::ranges::find(neighbours_, kNone, &Neighbour::second);
  const auto start = static_cast<std::uint32_t>(end == neighbours_.end() ? 0 : end - neighbours_.begin());
  std::size_t passed = 0;
  std::uint32_t at = start, wing = neighbours_[start].first;
  do {
    ++passed;
    const Wing& w = wings_[wing];
    at = vertices_[w.x == neighbours_[at].vertex ? w.y : w.x].number;
    wing = neighbours_[at].first == wing ? neighbours_[at].second : neighbours_[at].first;
  } while (wing != kNone && at != start);
  return passed == wings_.size();
}

// ---- the star of a vertex where something is wrong

void LiveSurface::examine_any(Slot v) {
  list_faces(v);
  examine_faces(v);
}

// The distinct triangles. Copies are counted; two that pass their corners in opposite directions do not agree.
void LiveSurface::list_faces(Slot v) {
  std::ranges::sort(wings_, {},
                    [](const Wing& w) { return std::tuple(std::min(w.x, w.y), std::max(w.x, w.y), w.triangle); });
  faces_.clear();
  for (const Wing& wing : wings_) {
    const auto [lo, hi] = std::minmax(wing.x, wing.y);
    const bool forward = wing.x == lo;
    if (faces_.empty() || faces_.back().lo != lo || faces_.back().hi != hi) {
      faces_.push_back({lo, hi, wing.triangle, forward});
      distinct_triangles_ += lo != hi && !vertices_[lo].finished && !vertices_[hi].finished ? 1u : 0u;
      continue;
    }
    oriented_ = oriented_ && faces_.back().forward == forward;
    if (lo == hi || vertices_[lo].finished || vertices_[hi].finished) continue;
    // The last digit of a mean depends on the order of the corners, and slots depend on how the mesh is read.
    std::array<Slot, 3> corners{v, lo, hi};
    std::ranges::sort(corners, {}, [&](Slot corner) { return vertices_[corner].id; });
    duplicates_.add(FirstPlaces::ascending(vertices_[v].id, vertices_[lo].id, vertices_[hi].id), mean(corners));
  }
}

void LiveSurface::examine_faces(Slot v) {
  sides_of_faces_.clear();
  for (std::uint32_t i = 0; i < faces_.size(); ++i) {
    const bool is_edge = faces_[i].lo == faces_[i].hi;
    sides_of_faces_.emplace_back(faces_[i].lo, is_edge ? kNone : i);
    if (!is_edge) sides_of_faces_.emplace_back(faces_[i].hi, i);
  }
  std::ranges::sort(sides_of_faces_);

  UnionFind link(static_cast<std::uint32_t>(neighbours_.size()));
  for (const Face& face : faces_) link.unite(vertices_[face.lo].number, vertices_[face.hi].number);
  bool has_triangle = false, is_line = true;
  for (std::size_t i = 0, end = 0; i < sides_of_faces_.size(); i = end) {
    const Slot w = sides_of_faces_[i].first;
    for (end = i; end < sides_of_faces_.size() && sides_of_faces_[end].first == w;) ++end;
    std::size_t triangles = 0;
    for (std::size_t j = i; j < end; ++j) triangles += sides_of_faces_[j].second != kNone ? 1u : 0u;
    has_triangle = has_triangle || triangles != 0;
    is_line = is_line && triangles <= 2 && link.find(vertices_[w].number) == link.find(0);
    if (vertices_[w].finished) continue;
    ++edges_;
    // A loose edge comes last.
    if (triangles == 0) {
      ++counts_.loose_edges;
    } else if (triangles == 1) {
      count_boundary_edge(v, w);
    } else if (triangles == 2) {
      const Face &a = faces_[sides_of_faces_[i].second], &b = faces_[sides_of_faces_[i + 1].second];
      const bool agree = (a.forward == (a.lo == w)) != (b.forward == (b.lo == w));
      oriented_ = oriented_ && agree;
      join_sides(a.triangle, b.triangle, !agree);
      count_inner_edge(v, w, a.lo == w ? a.hi : a.lo, b.lo == w ? b.hi : b.lo);
    } else {
      const std::array<Slot, 2> ends{v, w};
      nonmanifold_edges_.add(FirstPlaces::ascending(vertices_[v].id, vertices_[w].id), mean(ends));
    }
  }
  if (has_triangle && !is_line)
    nonmanifold_vertices_.add(FirstPlaces::ascending(vertices_[v].id), vertices_[v].position);
}

// ---- edges

void LiveSurface::count_boundary_edge(Slot v, Slot w) {
  Vertex &a = vertices_[v], &b = vertices_[w];
  Boundary edge{.edges = 1, .length = {}, .min = {}, .max = {}, .lowest = a.id, .position = a.position};
  edge.length = Length::of(length_between(a.position, b.position));
  for (std::size_t k = 0; k < 3; ++k) {
    edge.min[k] = std::min(a.position[k], b.position[k]);
    edge.max[k] = std::max(a.position[k], b.position[k]);
  }
  if (b.id < a.id) {
    edge.lowest = b.id;
    edge.position = b.position;
  }
  if (a.boundary == kNone && b.boundary == kNone) return boundaries_.bind(a.boundary, b.boundary, edge);
  boundaries_.bind(a.boundary, b.boundary, edge);
  boundaries_.value(a.boundary).join(edge);
}

void LiveSurface::count_inner_edge(Slot v, Slot w, Slot x, Slot y) {
  const Vertex &a = vertices_[v], &b = vertices_[w];
  if (!is_folded(a.position, b.position, vertices_[x].position, vertices_[y].position)) return;
  const std::array<Slot, 2> ends{v, w};
  folded_.add(FirstPlaces::ascending(a.id, b.id), mean(ends));
}

void LiveSurface::join_sides(std::uint32_t t, std::uint32_t u, bool opposite) {
  Triangle &a = triangles_[t], &b = triangles_[u];
  if (a.side == kNone && b.side == kNone) a.side = sides_.add({});
  if (a.side != kNone && b.side != kNone) {
    const bool flip = (a.flipped != b.flipped) != opposite;
    orientable_ = (a.side == b.side ? !flip : sides_.unite(a.side, b.side, flip)) && orientable_;
    return;
  }
  const auto& [known, other] = a.side != kNone ? std::tie(a, b) : std::tie(b, a);
  const auto root = sides_.find(known.side);
  other.side = root.set;
  other.flipped = (known.flipped != root.flipped) != opposite;
  sides_.hold(other.side);
}

Point LiveSurface::mean(std::span<const Slot> slots) const {
  Point sum{};
  for (const Slot slot : slots)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += vertices_[slot].position[k] / static_cast<double>(slots.size());
  return sum;
}

// ---- results

void LiveSurface::end_component(const Component& component) {
  ++counts_.components;
  surface_components_ += component.triangles != 0 ? 1 : 0;
  keep_first(counts_.largest_components,
             {component.triangles, component.vertices, place_of(component.lowest, component.position)},
             [](const CensusComponent& a, const CensusComponent& b) {
               return a.triangles != b.triangles ? a.triangles > b.triangles : a.first.vertices < b.first.vertices;
             });
}

void LiveSurface::end_boundary(const Boundary& boundary) {
  ++counts_.boundaries;
  keep_first(counts_.longest_boundaries,
             {boundary.edges, boundary.length.coarse + boundary.length.fine, boundary.min, boundary.max,
              place_of(boundary.lowest, boundary.position)},
             [](const CensusBoundary& a, const CensusBoundary& b) {
               return a.length != b.length ? a.length > b.length : a.first.vertices < b.first.vertices;
             });
}

MeshCensus LiveSurface::result() const {
  MeshCensus result = counts_;
  if (!surface_) {
    result.largest_components.clear();
    return result;
  }
  result.nonmanifold_edges = nonmanifold_edges_.result();
  result.nonmanifold_vertices = nonmanifold_vertices_.result();
  result.degenerate = degenerate_.result();
  result.duplicates = duplicates_.result();
  result.folded = folded_.result();
  result.euler = static_cast<std::int64_t>(counts_.vertices) - static_cast<std::int64_t>(edges_) +
                 static_cast<std::int64_t>(distinct_triangles_);
  result.closed = distinct_triangles_ != 0 && result.boundaries == 0 && result.loose_edges == 0;
  if (result.nonmanifold_edges.count == 0) {
    result.orientable = orientable_;
    result.oriented = oriented_;
  }
  result.why_no_genus = why_no_genus(result, distinct_triangles_ != 0);
  if (!result.why_no_genus.empty()) return result;
  // Each component has 2 - 2 * genus - boundaries for its Euler characteristic, and an isolated vertex has 1.
  const auto isolated = static_cast<std::int64_t>(result.components - surface_components_);
  const std::int64_t doubled = 2 * static_cast<std::int64_t>(surface_components_) -
                               static_cast<std::int64_t>(result.boundaries) - (result.euler - isolated);
  result.genus = static_cast<std::uint64_t>(doubled) / 2;
  return result;
}

std::uint64_t LiveSurface::memory_bytes() const {
  return vertices_.memory_bytes() + triangles_.memory_bytes() + components_.memory_bytes() +
         boundaries_.memory_bytes() + sides_.memory_bytes();
}

}  // namespace reeb::ooc
