#include "tools/defects/defect_rows.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "libreeb/defects/curve_relations.h"
#include "libreeb/defects/further_loops.h"
#include "ooc/patches/ball_clusters.h"
#include "ooc/patches/divided_surface.h"
#include "ooc/patches/near_balls.h"
#include "ooc/patches/space_order.h"
#include "ooc/threads/parallel.h"
#include "tools/program/quantity.h"

namespace reeb::tools {
namespace {

struct Candidate {
  std::uint32_t loop = 0;
  const FoundCurve* curve = nullptr;
  const FoundCurves* both = nullptr;
  ooc::Ball ball;
  double wide = 0;  // the radius of all that may be looked at around it
  bool first_function = false, testable = false, taken = false;
};

bool meet(const ooc::Ball& a, const ooc::Ball& b) { return distance(a.center, b.center) <= a.radius + b.radius; }

// By length; the rest settles ties.
bool before(const Candidate& a, const Candidate& b) {
  return std::tuple(a.curve->length, !a.first_function, a.loop, a.curve->path.size()) <
         std::tuple(b.curve->length, !b.first_function, b.loop, b.curve->path.size());
}

std::vector<Candidate> candidates(const LoopList& list, const PatchScale& scale,
                                  const std::vector<std::vector<FoundCurves>>& found) {
  std::vector<Candidate> result;
  std::size_t most = 0;
  for (const auto& patches : found) most += 2 * patches.size();
  result.reserve(most);
  const auto add = [&](std::uint32_t loop, const FoundCurves& both, const FoundCurve& curve) {
    const bool first = list.loops[loop].function == 0;
    if (curve.path.empty() || (!first && !curve.closed)) return;
    Candidate candidate{loop, &curve, &both, {}, 0, first, false, false};
    const auto& [least, most] = curve.place.box;
    for (std::size_t k = 0; k < 3; ++k) candidate.ball.center[k] = (least[k] + most[k]) / 2;
    candidate.ball.radius = 0.75 * distance(least, most) + 4 * curve.length / static_cast<double>(curve.path.size());
    candidate.testable = !scale.too_large(candidate.ball.radius);
    if (candidate.testable || first) result.push_back(candidate);
  };
  for (std::uint32_t i = 0; i < found.size(); ++i)
    for (const FoundCurves& both : found[i])
      for (const FoundCurve* curve : {&both.contour, &both.cycle}) add(i, both, *curve);
  std::sort(result.begin(), result.end(), before);
  // Two curves around one long handle are far from each other. Where there are few, patches show that.
  constexpr double kTogether = 1'000'000, kMost = 20'000;
  const double wide =
      scale.radius(std::min(kMost, kTogether / static_cast<double>(std::max<std::size_t>(1, result.size()))));
  for (Candidate& candidate : result) candidate.wide = std::max(candidate.ball.radius, wide);
  return result;
}

// The path in a patch; nothing if it is not all there.
ClosedPath in_patch(const SurfacePatch& patch, const FoundCurve& curve) {
  ClosedPath path;
  for (const VertexId vertex : curve.path) {
    const std::uint32_t v = patch.find(vertex);
    if (v == SurfacePatch::kNone || !patch.whole(v)) return {};
    path.vertices.push_back(v);
  }
  path.length = curve.length;
  return path;
}

// Whether the candidate crosses one of those taken an odd number of times, or bounds something together with them, in
// the patch. Nothing if the patch does not have all of it.
std::optional<bool> is_known(const SurfacePatch& patch, const Candidate& candidate,
                             std::span<const Candidate* const> taken) {
  const ClosedPath path = in_patch(patch, *candidate.curve);
  if (!path.exists()) return std::nullopt;
  std::vector<ClosedPath> others;
  for (const Candidate* other : taken)
    if (ClosedPath there = in_patch(patch, *other->curve); there.exists()) others.push_back(std::move(there));
  return depends_on(patch, path, others);
}

bool same_path(const Candidate& a, const Candidate& b) {
  const auto sorted = [](std::vector<VertexId> path) {
    std::sort(path.begin(), path.end());
    return path;
  };
  return a.curve->path.size() == b.curve->path.size() && sorted(a.curve->path) == sorted(b.curve->path);
}

void choose_in_cluster(const ooc::CollectedSurface& surface, std::vector<Candidate>& all,
                       std::span<const std::uint32_t> cluster, MemoryBudget& budget) {
  constexpr std::uint64_t kComparedBytesPerVertex = 400;  // of a patch, with what is_known() needs
  Reservation memory = budget.reserve("patches of curves", 0);
  const auto reserve = [&](std::size_t vertices) { memory.resize(kComparedBytesPerVertex * vertices); };
  ooc::NearBalls taken;
  std::set<std::uint32_t> loops;
  for (const std::uint32_t i : cluster) {
    Candidate& candidate = all[i];
    if (loops.contains(candidate.loop)) continue;
    candidate.taken = candidate.first_function;
    if (candidate.testable) {
      std::vector<const Candidate*> near;
      for (const std::uint32_t other : taken.meeting(candidate.ball)) near.push_back(&all[other]);
      // A curve alone can bound something, unless another one crosses it once. Functions often find the same path, or
      // one beside it, which a small patch shows.
      const auto known_in = [&](double share) -> std::optional<bool> {
        const auto smaller = [&](ooc::Ball ball) {
          ball.radius *= share;
          return ball;
        };
        std::vector<ooc::Ball> balls = {smaller(candidate.ball)};
        for (const Candidate* other : near)
          if (meet(balls[0], smaller(other->ball))) balls.push_back(smaller(other->ball));
        const auto patch = surface.cut(candidate.curve->path, balls, 8 * PatchScale::kMostVertices, reserve);
        return is_known(patch.surface, candidate, near);
      };
      const auto is_same = [&](const Candidate* other) { return same_path(*other, candidate); };
      if (near.empty())
        candidate.taken = !known_in(1).value_or(false);
      else if (std::ranges::any_of(near, is_same) || known_in(0.5).value_or(false))
        candidate.taken = false;
      else if (const auto known = known_in(1))
        candidate.taken = !*known;
      if (candidate.taken && candidate.wide > candidate.ball.radius) {
        const ooc::Ball wide{candidate.ball.center, candidate.wide};
        near.clear();
        for (const std::uint32_t other : taken.meeting(wide)) near.push_back(&all[other]);
        if (!near.empty()) {
          const auto patch =
              surface.cut(candidate.curve->path, std::span(&wide, 1), 8 * PatchScale::kMostVertices, reserve);
          candidate.taken = !is_known(patch.surface, candidate, near).value_or(false);
        }
      }
    }
    if (!candidate.taken) continue;
    taken.add(candidate.ball, i);
    loops.insert(candidate.loop);
  }
}

// Groups of candidates whose balls meet, directly or through others, each in the order of candidates. Groups near each
// other follow each other.
std::vector<std::vector<std::uint32_t>> clusters(const std::vector<Candidate>& all) {
  std::vector<ooc::Ball> balls;
  for (const Candidate& candidate : all) balls.push_back({candidate.ball.center, candidate.wide});
  std::vector<std::vector<std::uint32_t>> groups = ooc::clusters_of(balls), sorted;
  std::vector<Point> places;
  for (const auto& group : groups) places.push_back(all[group[0]].ball.center);
  for (const std::uint32_t i : ooc::order_in_space(places)) sorted.push_back(std::move(groups[i]));
  return sorted;
}

// Clusters that are compared together, as many as the memory allows: where each such stretch ends.
std::vector<std::size_t> stretches(const std::vector<Candidate>& all,
                                   const std::vector<std::vector<std::uint32_t>>& clusters, const PatchScale& scale,
                                   std::uint64_t patch_bytes) {
  const double most = static_cast<double>(patch_bytes / PatchScale::kBytesPerVertex);
  std::vector<std::size_t> ends;
  double sum = 0;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    if (sum >= most) {
      ends.push_back(i);
      sum = 0;
    }
    for (const std::uint32_t c : clusters[i])
      if (all[c].testable) sum += scale.vertices(all[c].wide) / 2;
  }
  ends.push_back(clusters.size());
  return ends;
}

void choose(const ValuedMesh& mesh, const PatchScale& scale, std::vector<Candidate>& all,
            const SearchOptions& options) {
  const auto groups = clusters(all);
  const std::vector<std::size_t> ends = stretches(all, groups, scale, options.patch_bytes);
  std::vector<ooc::GroupedBall> balls;
  for (std::uint32_t stretch = 0, i = 0; stretch < ends.size(); ++stretch)
    for (; i < ends[stretch]; ++i)
      for (const std::uint32_t c : groups[i])
        if (all[c].testable) balls.push_back({{all[c].ball.center, all[c].wide}, stretch});
  ooc::DividedSurface surfaces(balls, ends.size(), 0, *options.temp, *options.budget);
  if (!balls.empty()) {
    std::uint64_t triangles = 0;
    mesh.read(
        [&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
          surfaces.add(batch, {});
          triangles += batch.triangle_count();
          if (options.progress) options.progress(done, total, triangles);
        });
  }
  surfaces.finish();
  std::size_t begin = 0;
  for (std::uint32_t stretch = 0; stretch < ends.size(); ++stretch) {
    const ooc::CollectedSurface surface = surfaces.surface(stretch);
    ooc::in_parallel(options.threads, ends[stretch] - begin,
                     [&](std::size_t i) { choose_in_cluster(surface, all, groups[begin + i], *options.budget); });
    begin = ends[stretch];
  }
}

DefectRow row_of(const LoopList& list, std::uint32_t number, const FoundCurves* found, const FoundCurve* curve) {
  const Loop& loop = list.loops[number];
  const ValueRange& range = list.functions[loop.function].range;
  DefectRow row;
  row.function = loop.function;
  row.lo = loop.lo;
  row.hi = loop.hi;
  row.persistence = loop.hi.key.value - loop.lo.key.value;
  row.percent = range.max > range.min ? percent_of(range, loop.lo.key.value, loop.hi.key.value) : 0;
  if (curve != nullptr) {
    row.curve = *curve;
    row.kind = curve->kind;
    // If the other curve of the loop is shorter, it was not taken: it is one of a defect that another row has.
    const auto length = [&](const FoundCurve& c) {
      return &c != curve && c.length < curve->length && !c.path.empty() ? std::numeric_limits<double>::infinity()
                                                                        : c.length;
    };
    row.length_contour = length(found->contour);
    row.length_cycle = length(found->cycle);
    const FoundCurve& other = curve == &found->contour ? found->cycle : found->contour;
    if (length(other) < std::numeric_limits<double>::infinity()) row.other_path = other.path;
    // A shorter contour that is not along edges, as around a vertex where two sheets meet.
    if (length(other) < curve->length && row.kind == DefectKind::kUnclear) {
      row.curve = other;
      row.other_path = curve->path;
    }
    return row;
  }
  row.curve.place = curve_place(std::array{loop.lo.position, loop.hi.position});
  return row;
}

// What is listed so far.
struct Listing {
  std::vector<const Candidate*> taken;  // curves with a row
  std::vector<std::uint8_t> used;       // of each loop, whether it has a row
  DefectTable table;
};

// The curves of several loops can be the same: then only one of them has a row with it. In a small mesh, the other
// loops of a closed component get further curves, each the row of the loop that is nearest to it.
void add_further(const ValuedMesh& mesh, const LoopList& list, const PatchScale& scale, const SearchOptions& options,
                 Listing& listing) {
  constexpr std::uint64_t kMostLoops = 512, kMostRoots = 64;
  if (list.functions[0].mesh.vertices > PatchScale::kMostVertices) return;
  std::vector<std::vector<std::uint32_t>> left(list.functions[0].tops.size());  // loops of each component that has any
  for (std::uint32_t i = 0; i < list.loops.size(); ++i)
    if (list.loops[i].function == 0 && listing.used[i] == 0) left[list.loops[i].component].push_back(i);
  if (std::ranges::all_of(left, &std::vector<std::uint32_t>::empty)) return;
  const ooc::Ball all_of_it{list.box[0], 2 * scale.size};
  ooc::DividedSurface surfaces(std::vector{ooc::GroupedBall{all_of_it, 0}}, 1, 0, *options.temp, *options.budget);
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t, std::uint64_t) {
    surfaces.add(batch, {});
  });
  surfaces.finish();
  const ooc::CollectedSurface surface = surfaces.surface(0);
  for (std::vector<std::uint32_t>& loops : left) {
    if (loops.empty()) continue;
    const std::array seeds = {list.loops[loops[0]].lo.key.vertex};
    const SurfacePatch patch = surface.cut(seeds, std::span(&all_of_it, 1), PatchScale::kMostVertices).surface;
    if (!is_closed_surface(patch)) continue;
    std::vector<ClosedPath> known;
    for (const Candidate* candidate : listing.taken)
      if (ClosedPath path = in_patch(patch, *candidate->curve); path.exists()) known.push_back(std::move(path));
    const auto roots = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(kMostLoops / (known.size() + loops.size()), 4, kMostRoots));
    const bool inwards = is_inwards(patch, 0, 0).value_or(false);
    for (const ClosedPath& path : further_loops(patch, known, loops.size(), roots)) {
      FoundCurves found;
      found.cycle = in_mesh(patch, curve_along(patch, path));
      if (found.cycle.length > scale.longest()) break;
      if (inwards) turn(found.cycle);
      const auto nearest = std::ranges::min_element(loops, {}, [&](std::uint32_t i) {
        return distance(list.loops[i].lo.position, found.cycle.place.center) +
               distance(list.loops[i].hi.position, found.cycle.place.center);
      });
      listing.used[*nearest] = 1;
      listing.table.rows.push_back(row_of(list, *nearest, &found, &found.cycle));
      loops.erase(nearest);
    }
  }
}

// With the shortest curve of each.
void add_named(const LoopList& list, const std::vector<Candidate>& sorted, const std::set<LoopName>& named,
               DefectTable& table) {
  if (named.empty()) return;
  std::set<LoopName> listed;
  for (const DefectRow& row : table.rows)
    listed.insert(name_of(list, {.function = row.function, .lo = row.lo, .hi = row.hi}));
  for (std::uint32_t i = 0; i < list.loops.size(); ++i) {
    const LoopName name = name_of(list, list.loops[i]);
    if (!named.contains(name) || listed.contains(name)) continue;
    const auto shortest = std::ranges::find(sorted, i, &Candidate::loop);
    table.rows.push_back(shortest == sorted.end() ? row_of(list, i, nullptr, nullptr)
                                                  : row_of(list, i, shortest->both, shortest->curve));
  }
}

}  // namespace

DefectTable make_rows(const ValuedMesh& mesh, const LoopList& list, const LoopCurvesFound& search,
                      const SearchOptions& options, const std::set<LoopName>& named) {
  const auto& [found, scale, memory] = search;
  std::vector<Candidate> all = candidates(list, scale, found);
  choose(mesh, scale, all, options);

  const auto wanted =
      static_cast<std::size_t>(std::ranges::count_if(list.loops, [](const Loop& loop) { return loop.function == 0; }));
  Listing listing;
  auto& [taken, used, table] = listing;
  for (const Candidate& candidate : all)
    if (candidate.taken) taken.push_back(&candidate);
  // No more than there are loops of the first function; the longest of other functions are left out.
  for (std::size_t i = taken.size(); i-- > 0 && taken.size() > wanted;)
    if (!taken[i]->first_function) taken.erase(taken.begin() + static_cast<std::ptrdiff_t>(i));

  used.resize(list.loops.size(), 0);
  std::vector<std::uint8_t> had_curves(list.loops.size(), 0);
  for (const Candidate& candidate : all) had_curves[candidate.loop] = 1;
  for (const Candidate* candidate : taken) {
    used[candidate->loop] = 1;
    table.rows.push_back(row_of(list, candidate->loop, candidate->both, candidate->curve));
  }
  if (table.rows.size() < wanted) add_further(mesh, list, scale, options, listing);
  // The other loops of the first function: first those whose curves left their patches. Curves of the rest stand for
  // defects that are listed already.
  for (const bool with_curves : {false, true})
    for (std::uint32_t i = 0; i < list.loops.size() && table.rows.size() < wanted; ++i)
      if (list.loops[i].function == 0 && used[i] == 0 && (had_curves[i] != 0) == with_curves)
        table.rows.push_back(row_of(list, i, nullptr, nullptr));

  std::vector<double> lengths;
  for (const DefectRow& row : table.rows) lengths.push_back(row.length());
  // A defect that lies badly for one coordinate has a short curve for another.
  const bool looked_well = list.functions.size() >= std::min(3u, mesh.info().dimension);
  table.suggestion = suggest_length(lengths, scale.edge, scale.size, looked_well);
  // Small and clear, small and unclear, then the rest by length; long ones that are small for the function first.
  const double limit = table.suggestion.length.value_or(0);
  const auto key = [&](const DefectRow& row) {
    const int group = row.length() > limit ? 2 : row.kind == DefectKind::kUnclear ? 1 : 0;
    return std::tuple(group, row.length(), row.percent, row.function, row.lo.key.vertex, row.hi.key.vertex);
  };
  std::sort(table.rows.begin(), table.rows.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  add_named(list, all, named, table);
  return std::move(table);
}

}  // namespace reeb::tools
