#include "tools/defects/curve_search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <utility>

#include "libreeb/base/error.h"
#include "libreeb/base/hash.h"
#include "libreeb/containers/flat_map.h"
#include "ooc/patches/divided_surface.h"
#include "ooc/patches/space_cells.h"
#include "ooc/patches/space_order.h"
#include "ooc/threads/parallel.h"
#include "tools/checks/node_places.h"
#include "tools/defects/component_tops.h"

namespace reeb::tools {
namespace {

constexpr double kFirstEdges = 6;  // the radius of the first patches, in edges
constexpr int kMostReadings = 14;

bool same(const FoundCurve& a, const FoundCurve& b) { return a.found() && b.found() && a.path == b.path; }

std::optional<std::size_t> axis_of(const std::string& function) {
  const io::FunctionSpec spec = io::parse_function(function);
  if (spec.kind != io::FunctionSpec::Kind::kCoordinate || spec.number > 2) return std::nullopt;
  return spec.number;
}

// What is looked for around two vertices: the curves of a loop, or the orientation at the top of a component.
struct Search {
  std::uint32_t function = 0, number = 0;  // the loop, or the component
  bool is_top = false, done = false;
  int tried = 0;  // how many patches
  double radius = 0;
};

std::uint64_t bytes_of(const FoundCurves& curves) {
  return sizeof(FoundCurves) + 32 + 8 * (curves.contour.path.capacity() + curves.cycle.path.capacity());
}

class CurveSearch {
 public:
  CurveSearch(const ValuedMesh& mesh, const LoopList& list, const PatchScale& scale, const SearchOptions& options)
      : mesh_(mesh),
        list_(list),
        scale_(scale),
        options_(options),
        patch_bytes_(options.patch_bytes),
        memory_(options.budget->reserve("curves of loops", 0)),
        search_memory_(
            options.budget->reserve("curves of loops", list.loops.size() * (sizeof(Search) + sizeof(found_[0])))),
        found_(list.loops.size()) {
    std::size_t tops = 0;
    for (const LoopFunction& function : list.functions) tops += function.tops.size();
    search_memory_.resize(search_memory_.bytes() +
                          tops * (sizeof(Search) + sizeof(SettledNode) + sizeof(inwards_[0][0])));
    for (const LoopFunction& function : list.functions) {
      inwards_.emplace_back(function.tops.size(), 0);
      tops_.push_back(function.tops);
    }
    searches_.reserve(list.loops.size() + tops);
    for (std::uint32_t i = 0; i < list.loops.size(); ++i) {
      const Loop& loop = list.loops[i];
      const double apart = distance(loop.lo.position, loop.hi.position);
      add({static_cast<std::uint32_t>(loop.function), i, false, false, 0,
           std::max(kFirstEdges * scale.edge, 0.6 * apart)});
    }
    for (std::uint32_t f = 0; f < list.functions.size(); ++f) {
      if (tops_[f].empty()) continue;
      if (!axis_of(list.functions[f].name)) tops_[f] = component_tops(mesh, list.functions[f], f, *options.budget);
      for (std::uint32_t c = 0; c < tops_[f].size(); ++c) add({f, c, true, false, 0, kFirstEdges * scale.edge});
    }
  }

  LoopCurvesFound run() {
    for (int turn = 0; turn < kMostReadings; ++turn) {
      std::vector<std::uint32_t> now = open(turn);
      while (!now.empty()) {
        try {
          read(now);
        } catch (const Error& error) {
          // More vertices than was thought are near the loops.
          if (error.kind() != ErrorKind::kResource || patch_bytes_ < kLeastBytes) throw;
          patch_bytes_ /= 2;
        }
        now = open(turn);
      }
    }
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const Loop& loop = list_.loops[i];
      if (inwards_[loop.function][loop.component] == 0) continue;
      for (FoundCurves& curves : found_[i])
        for (FoundCurve* curve : {&curves.contour, &curves.cycle}) turn(*curve);
    }
    return {std::move(found_), scale_, std::move(memory_)};
  }

 private:
  static constexpr std::uint64_t kLeastBytes = PatchScale::kMostVertices * PatchScale::kBytesPerVertex;

  void add(Search search) {
    search.done = scale_.too_large(search.radius);
    searches_.push_back(search);
  }

  const SettledNode& lo(const Search& search) const {
    return search.is_top ? tops_[search.function][search.number] : list_.loops[search.number].lo;
  }
  const SettledNode& hi(const Search& search) const {
    return search.is_top ? tops_[search.function][search.number] : list_.loops[search.number].hi;
  }

  // Those that need a further patch in this turn.
  std::vector<std::uint32_t> open(int turn) const {
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < searches_.size(); ++i)
      if (!searches_[i].done && searches_[i].tried <= turn) result.push_back(i);
    return result;
  }

  // Groups of searches near each other, as large as patch_bytes_ allows; each but the last begins where the one before
  // it ends. Patches of several functions at one place share vertices. Changes the order of the searches.
  std::vector<std::size_t> divide(std::vector<std::uint32_t>& now) const {
    std::vector<Point> places;
    places.reserve(now.size());
    for (const std::uint32_t i : now) places.push_back(lo(searches_[i]).position);
    std::vector<std::uint32_t> sorted;
    sorted.reserve(now.size());
    for (const std::uint32_t i : ooc::order_in_space(places)) sorted.push_back(now[i]);
    now = std::move(sorted);
    const double most = static_cast<double>(std::max(patch_bytes_, kLeastBytes) / PatchScale::kBytesPerVertex);
    std::vector<std::size_t> ends;
    double sum = 0;
    FlatMap seen;
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (sum >= most) {
        ends.push_back(i);
        sum = 0;
        seen.clear();
      }
      sum += new_vertices(searches_[now[i]], seen);
    }
    ends.push_back(now.size());
    return ends;
  }

  // Vertices in the balls of the search, roughly, but for balls like those seen before.
  double new_vertices(const Search& search, FlatMap& seen) const {
    double sum = 0;
    for (const SettledNode* node : {&lo(search), &hi(search)}) {
      auto key = static_cast<std::uint64_t>(std::ilogb(search.radius));
      for (const std::int64_t c : ooc::cell_at(node->position, 1 / search.radius))
        key = mix(key ^ static_cast<std::uint64_t>(c));
      const auto entry = static_cast<std::uint32_t>(seen.size());
      if (seen.find_or_insert(key, entry) == entry) sum += scale_.vertices(search.radius);
    }
    return sum;
  }

  // Edges are measured near every search, or every second, third, ... one where there are many.
  std::uint32_t measured_step(std::span<const std::uint32_t> now) const {
    constexpr double kMostMeasured = 400'000;  // vertices
    double sum = 0;
    FlatMap seen;
    for (const std::uint32_t i : now) sum += new_vertices(searches_[i], seen);
    return 1 + static_cast<std::uint32_t>(sum / kMostMeasured);
  }

  void read(std::vector<std::uint32_t>& now) {
    const std::uint32_t step = is_measured_ ? 0 : measured_step(now);
    const std::vector<std::size_t> ends = divide(now);
    ooc::DividedSurface surfaces = collect(now, ends, step);
    if (const double edge = surfaces.mean_edge(); edge > 0) scale_.edge = edge;
    is_measured_ = true;
    for (std::uint32_t group = 0, i = 0; group < ends.size(); ++group) {
      const ooc::CollectedSurface surface = surfaces.surface(group);
      const std::span<const std::uint32_t> here(now.data() + i, ends[group] - i);
      ooc::in_parallel(options_.threads, here.size(), [&](std::size_t k) { search_in(surface, searches_[here[k]]); });
      i = static_cast<std::uint32_t>(ends[group]);
      memory_.resize(found_bytes_);
      if (options_.progress) options_.progress(i, now.size(), list_.functions[0].mesh.triangles);
    }
  }

  ooc::DividedSurface collect(std::span<const std::uint32_t> now, std::span<const std::size_t> ends,
                              std::uint32_t measured_step) const {
    std::vector<ooc::GroupedBall> balls;
    balls.reserve(2 * now.size());
    for (std::uint32_t group = 0, i = 0; group < ends.size(); ++group)
      for (; i < ends[group]; ++i)
        for (const SettledNode* node : {&lo(searches_[now[i]]), &hi(searches_[now[i]])})
          balls.push_back(
              {{node->position, searches_[now[i]].radius}, group, measured_step != 0 && now[i] % measured_step == 0});
    ooc::DividedSurface surfaces(balls, ends.size(), list_.functions.size(), *options_.temp, *options_.budget);
    std::vector<ooc::GroupedBall>().swap(balls);
    std::uint64_t triangles = 0;
    mesh_.read([&](const MeshBatch& batch, std::span<const std::vector<double>> values, std::uint64_t done,
                   std::uint64_t total) {
      surfaces.add(batch, values);
      triangles += batch.triangle_count();
      if (options_.progress) options_.progress(done, total, triangles);
    });
    surfaces.finish();
    return surfaces;
  }

  ooc::CollectedSurface::Patch cut(const ooc::CollectedSurface& surface, const Search& search,
                                   const std::function<void(std::size_t)>& reserve) const {
    const SettledNode &low = lo(search), &high = hi(search);
    const std::array seeds = {low.key.vertex, high.key.vertex};
    const std::array balls = {ooc::Ball{low.position, search.radius}, ooc::Ball{high.position, search.radius}};
    return surface.cut(seeds, balls, PatchScale::kMostVertices, reserve);
  }

  void search_in(const ooc::CollectedSurface& surface, Search& search) {
    const SettledNode &low = lo(search), &high = hi(search);
    constexpr std::uint64_t kBytesPerVertex = 700;  // of a patch, with what a search in it needs
    Reservation own = options_.budget->reserve("patches of loops", 0);
    const ooc::CollectedSurface::Patch patch =
        cut(surface, search, [&](std::size_t vertices) { own.resize(kBytesPerVertex * vertices); });
    const std::uint32_t v = patch.surface.find(low.key.vertex), y = patch.surface.find(high.key.vertex);
    for (const auto& [at, node] : {std::pair(v, &low), std::pair(y, &high)}) {
      if (at == SurfacePatch::kNone) throw wrong_mesh(mesh_.path(), node->key.vertex, "is elsewhere in the mesh");
      if (patch.values[search.function][at] != node->key.value)
        throw wrong_mesh(mesh_.path(), node->key.vertex, "has another value in the mesh");
    }
    ++search.tried;
    if (patch.surface.whole(v) && patch.surface.whole(y)) {
      search.done = search.is_top ? orient(patch.surface, search, v) : measure(patch, search, v, y);
      if (search.done) return;
    }
    double longest = 0;
    for (const std::uint32_t x : {v, y})
      for (const std::uint32_t e : patch.surface.edges_at(x)) longest = std::max(longest, patch.surface.edge(e).length);
    search.radius = std::max(2 * search.radius, kFirstEdges * longest);
    search.done = patch.limited || scale_.too_large(search.radius);
  }

  // Whether the patch was large enough.
  bool orient(const SurfacePatch& patch, const Search& search, std::uint32_t top) {
    const auto inwards = is_inwards(patch, top, axis_of(list_.functions[search.function].name).value_or(0));
    inwards_[search.function][search.number] = inwards.value_or(false) ? 1 : 0;
    return inwards.has_value();
  }

  // Whether the patch was large enough.
  bool measure(const ooc::CollectedSurface::Patch& patch, const Search& search, std::uint32_t v, std::uint32_t y) {
    const LoopCurves curves = loop_curves(
        patch.surface, patch.values[search.function],
        {v, y, list_.loops[search.number].lo_divides, list_.loops[search.number].hi_joins}, scale_.longest());
    FoundCurves found = {in_mesh(patch.surface, curves.contour), in_mesh(patch.surface, curves.cycle)};
    std::vector<FoundCurves>& all = found_[search.number];
    found_bytes_ += bytes_of(found);
    // The same again, with more known of the other curve.
    if (!all.empty() && (same(all.back().contour, found.contour) || same(all.back().cycle, found.cycle)))
      all.back() = std::move(found);
    else if (found.contour.found() || found.cycle.found())
      all.push_back(std::move(found));
    const double shorter = std::min(curves.contour.length, curves.cycle.length);
    if (curves.contour.found() && curves.cycle.found()) return shorter <= 2 * search.radius;
    return shorter <= search.radius;
  }

  const ValuedMesh& mesh_;
  const LoopList& list_;
  PatchScale scale_;
  bool is_measured_ = false;
  const SearchOptions& options_;
  std::uint64_t patch_bytes_;
  Reservation memory_, search_memory_;
  std::atomic<std::uint64_t> found_bytes_ = 0;
  std::vector<Search> searches_;
  std::vector<std::vector<SettledNode>> tops_;
  std::vector<std::vector<FoundCurves>> found_;
  std::vector<std::vector<std::uint8_t>> inwards_;  // by function and component
};

}  // namespace

double PatchScale::vertices(double radius) const {
  const double edges = edge > 0 ? radius / edge : 0;
  return 16 + 7 * edges * edges;
}

double PatchScale::radius(double vertices) const { return edge * std::sqrt(std::max(0.0, vertices - 16) / 7); }

PatchScale scale_of(const LoopList& list) {
  PatchScale scale;
  const Point extent = list.box[1] - list.box[0];
  if (!(extent[0] >= 0)) return scale;
  scale.size = distance(list.box[0], list.box[1]);
  const double area = 2 * (extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0]);
  const auto triangles = static_cast<double>(std::max<std::uint64_t>(1, list.functions[0].mesh.triangles));
  scale.edge = std::max(std::sqrt(2.3 * area / triangles), 1e-6 * scale.size);
  return scale;
}

std::optional<bool> is_inwards(const SurfacePatch& patch, std::uint32_t top, std::size_t axis) {
  constexpr double kRounding = 1e-9;
  constexpr double kMostOpen = 0.25;  // the size of a hole's flat filling, of the area
  std::vector<std::uint8_t> seen(patch.vertex_count(), 0), in_cap(patch.vertex_count(), 0);
  std::priority_queue<std::pair<double, std::uint32_t>> highest;
  const auto reach = [&](std::uint32_t v) {
    if (seen[v] == 0) highest.emplace(patch.position(v)[axis], v);
    seen[v] = 1;
  };
  reach(top);
  for (; !highest.empty() && patch.whole(highest.top().second);) {
    const std::uint32_t v = highest.top().second;
    highest.pop();
    in_cap[v] = 1;
    for (const std::uint32_t e : patch.edges_at(v)) reach(patch.edge(e).a == v ? patch.edge(e).b : patch.edge(e).a);
  }
  std::vector<std::uint32_t> cap;
  for (std::uint32_t t = 0; t < patch.triangle_count(); ++t)
    if (std::ranges::all_of(patch.triangle(t), [&](std::uint32_t v) { return in_cap[v] != 0; })) cap.push_back(t);
  Point normals = {}, origin = patch.position(top);
  double area = 0, rim = 0;
  for (const std::uint32_t t : cap) {
    const Point normal = patch.normal(t);
    for (std::size_t k = 0; k < 3; ++k) normals[k] += normal[k];
    area += distance(normal, {});
    for (const std::uint32_t e : patch.edges_of(t)) {
      if (patch.triangles_at_edge(e).size() == 2) continue;
      // The origin moves to the middle of the rims, so that what fills them adds little to the volume.
      const SurfacePatch::Edge& edge = patch.edge(e);
      rim += edge.length;
      const Point offset = patch.position(edge.a) - origin;
      for (std::size_t k = 0; k < 3 && rim > 0; ++k) origin[k] += offset[k] * edge.length / rim;
    }
  }
  const bool has_volume = highest.empty() && distance(normals, {}) <= kMostOpen * area;
  double outwards = 0, size = 0;
  for (const std::uint32_t t : cap) {
    double part = patch.normal(t)[axis];
    if (has_volume) {
      const auto [a, b, c] = patch.oriented(t);
      part = dot(patch.position(a) - origin, cross(patch.position(b) - origin, patch.position(c) - origin));
    }
    outwards += part;
    size += std::abs(part);
  }
  if (!(std::abs(outwards) > kRounding * size)) return std::nullopt;
  return outwards < 0;
}

void turn(FoundCurve& curve) {
  curve.kind = opposite(curve.kind);
  curve.inwards = !curve.inwards;
}

FoundCurve in_mesh(const SurfacePatch& patch, const LoopCurve& curve) {
  FoundCurve found;
  found.length = curve.length;
  found.triangles = curve.triangles;
  found.closed = !curve.crossings.empty();
  found.kind = kind_of(patch, curve, false);
  found.place = curve.place;
  found.path.reserve(curve.path.vertices.size());
  for (const std::uint32_t v : curve.path.vertices) found.path.push_back(patch.vertex(v));
  return found;
}

LoopCurvesFound find_curves(const ValuedMesh& mesh, const LoopList& list, const PatchScale& scale,
                            const SearchOptions& options) {
  return CurveSearch(mesh, list, scale, options).run();
}

}  // namespace reeb::tools
