#include "ooc/whole_mesh/mesh_recount.h"

#include <algorithm>
#include <array>
#include <compare>
#include <span>
#include <vector>

#include "ooc/sorting/external_sort.h"
#include "ooc/tables/paged_union_find.h"

namespace reeb::ooc {
namespace {

// Simplices as sets of vertices, ascending.
struct Triangle {
  std::array<std::uint64_t, 3> corners;
  friend auto operator<=>(const Triangle&, const Triangle&) = default;
};

struct EdgeUse {
  static constexpr std::uint64_t kLoose = ~std::uint64_t{0};  // of no triangle

  std::uint64_t lo, hi;
  std::uint64_t use = kLoose;  // triangle * 3 + the index of the opposite corner
  friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;

  bool same_edge(const EdgeUse& other) const { return lo == other.lo && hi == other.hi; }
  // The corners of the triangle at lo and at hi.
  std::array<std::uint64_t, 2> corners() const {
    const std::uint64_t opposite = use % 3, first = use - opposite;
    return {first + (opposite == 0 ? 1 : 0), first + (opposite == 2 ? 1 : 2)};
  }
};

class Simplices {
 public:
  explicit Simplices(Workspace& space)
      : triangles_("recount", space.temp, space.budget, {.allowance_bytes = space.share()}),
        edges_("recount", space.temp, space.budget, {.allowance_bytes = space.share()}),
        components_("recount", space.temp, space.budget, space.share()),
        used_("recount", space.temp, space.budget, space.share(), 0),
        fans_("recount", space.temp, space.budget, space.share()) {}

  void add(const MeshBatch& batch) {
    vertices_ += batch.vertex_count;
    listed_ += batch.triangle_count();
    batch.for_each_simplex([this](std::span<const VertexId> v) {
      const std::size_t n = v.size();
      if (n < 3) return add_triangle(v[0].value(), v[n - 1].value(), v[n - 1].value());
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
          for (std::size_t k = j + 1; k < n; ++k) add_triangle(v[i].value(), v[j].value(), v[k].value());
    });
  }

  MeshRecount finish() {
    MeshRecount result;
    result.vertices = vertices_;
    result.triangles = listed_;
    result.components = vertices_ - components_.unions();
    list_edges_of_triangles();
    count_edges();
    result.euler = static_cast<std::int64_t>(vertices_) - static_cast<std::int64_t>(distinct_edges_) +
                   static_cast<std::int64_t>(distinct_triangles_);
    judge_surface(result);
    return result;
  }

 private:
  void add_triangle(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    components_.unite(a, b);
    components_.unite(a, c);
    if (a == b || b == c || a == c) {
      // At most two distinct corners.
      const auto [lo, hi] = std::minmax({a, b, c});
      if (lo != hi) edges_.add(EdgeUse{lo, hi});
      return;
    }
    Triangle triangle{{a, b, c}};
    std::ranges::sort(triangle.corners);
    triangles_.add(triangle);
    for (const std::uint64_t corner : triangle.corners) use(corner);
  }

  void use(std::uint64_t vertex) {
    std::uint8_t& used = used_.change(vertex);
    surface_vertices_ += used == 0;
    used = 1;
  }

  void list_edges_of_triangles() {
    triangles_.finish();
    Triangle before{{0, 0, 0}};
    for (std::vector<Triangle> piece; triangles_.read(piece, kRecordsAtOnce);)
      for (const Triangle& triangle : piece) {
        if (triangle == before) continue;
        before = triangle;
        const auto& [a, b, c] = triangle.corners;
        const std::uint64_t first = distinct_triangles_++ * 3;
        edges_.add(EdgeUse{b, c, first});
        edges_.add(EdgeUse{a, c, first + 1});
        edges_.add(EdgeUse{a, b, first + 2});
      }
  }

  void count_edges() {
    edges_.finish();
    std::vector<EdgeUse> same;
    for (std::vector<EdgeUse> piece; edges_.read(piece, kRecordsAtOnce);)
      for (const EdgeUse& edge : piece) {
        if (!same.empty() && !same[0].same_edge(edge)) {
          count_edge(same);
          same.clear();
        }
        if (same.size() < 4) same.push_back(edge);  // more of them say nothing more
      }
    if (!same.empty()) count_edge(same);
  }

  void count_edge(std::vector<EdgeUse>& same) {
    ++distinct_edges_;
    std::erase_if(same, [](const EdgeUse& edge) { return edge.use == EdgeUse::kLoose; });
    if (same.empty() || same.size() > 2) {
      surface_ = false;
    } else if (same.size() == 1) {
      const std::uint64_t component = components_.find(same[0].lo);
      std::uint8_t& mark = used_.change(component);
      bounded_components_ += mark != 2;
      mark = 2;
    } else {
      const auto a = same[0].corners(), b = same[1].corners();
      fans_.unite(a[0], b[0]);
      fans_.unite(a[1], b[1]);
    }
  }

  // A surface's b1 is b0 + b2 - euler, and b2 (modulo 2) the number of its closed components; of
  // closed ones, b1 is twice the genus.
  void judge_surface(MeshRecount& result) const {
    const std::uint64_t fans = 3 * distinct_triangles_ - fans_.unions();
    if (!surface_ || fans != surface_vertices_) return;
    const std::uint64_t points = vertices_ - surface_vertices_;
    const auto b0 = static_cast<std::int64_t>(result.components - points);
    const auto b2 = b0 - static_cast<std::int64_t>(bounded_components_);
    const auto b1 = static_cast<std::uint64_t>(b0 + b2 - (result.euler - static_cast<std::int64_t>(points)));
    result.closed = bounded_components_ == 0;
    result.most_loops = result.closed ? b1 / 2 : b1;
  }

  static constexpr std::size_t kRecordsAtOnce = 4096;

  ExternalSort<Triangle> triangles_;
  ExternalSort<EdgeUse> edges_;
  PagedUnionFind components_;
  PagedTable<std::uint8_t> used_;  // by a triangle: 1; the name of a component with boundary: 2
  PagedUnionFind fans_;            // corners of distinct triangles, joined across edges
  std::uint64_t vertices_ = 0, listed_ = 0, surface_vertices_ = 0;
  std::uint64_t distinct_triangles_ = 0, distinct_edges_ = 0, bounded_components_ = 0;
  bool surface_ = true;
};

}  // namespace

MeshRecount recount_mesh(MeshReader& reader, Workspace& space, const BatchObserver& observe) {
  Simplices simplices(space);
  for (MeshBatch batch; reader.read(batch);) {
    if (observe) observe(batch);
    simplices.add(batch);
  }
  return simplices.finish();
}

}  // namespace reeb::ooc
