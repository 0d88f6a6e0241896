#include "libreeb/repair/curve_cut.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "libreeb/base/vector3.h"
#include "libreeb/repair/curve_band.h"
#include "libreeb/repair/number_set.h"
#include "libreeb/repair/patch_edit.h"
#include "libreeb/repair/rim_filling.h"
#include "libreeb/repair/tight_curve.h"
#include "libreeb/repair/triangle_split.h"

namespace reeb {
namespace {

constexpr int kMostGrowth = 2;  // rings that a band is widened by

PatchNumbers corners_of(const EditablePatch& patch, const PatchNumbers& triangles) {
  PatchNumbers result;
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t v : patch.triangle(t).corners) result.push_back(v);
  make_set(result);
  return result;
}

// The vertices less the edges plus the triangles that have no other vertices than these.
std::int64_t euler_among(const EditablePatch& patch, const PatchNumbers& sorted) {
  const auto in = [&](std::uint32_t v) { return std::ranges::binary_search(sorted, v); };
  std::int64_t vertices = 0, triangles = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const std::uint32_t v : sorted) {
    vertices += patch.is_used(v) ? 1 : 0;
    patch.for_each_at(v, [&](std::uint32_t t) {
      const auto& c = patch.triangle(t).corners;
      for (const std::uint32_t w : c)
        if (w > v && in(w)) edges.emplace_back(v, w);
      if (std::ranges::min(c) == v && in(c[0]) && in(c[1]) && in(c[2])) ++triangles;
    });
  }
  std::sort(edges.begin(), edges.end());
  const auto distinct = std::unique(edges.begin(), edges.end()) - edges.begin();
  return vertices - distinct + triangles;
}

// Whether a way along triangles leads from one rim to the other.
bool are_connected(const EditablePatch& patch, const PatchNumbers& from, const PatchNumbers& to) {
  NumberSet goal, reached;
  for (const std::uint32_t v : to) goal.add(v);
  reached.add(from[0]);
  for (std::size_t i = 0; i < reached.list().size(); ++i) {
    bool found = false;
    patch.for_each_at(reached.list()[i], [&](std::uint32_t t) {
      for (const std::uint32_t v : patch.triangle(t).corners) {
        reached.add(v);
        found = found || goal.has(v);
      }
    });
    if (found) return true;
  }
  return false;
}

bool is_manifold(const EditablePatch& patch, const PatchEdit& edit, const PatchNumbers& touched, std::int64_t euler) {
  for (const std::uint32_t v : touched)
    if (patch.is_used(v) && !patch.is_closed_fan(v)) return false;
  return euler_among(patch, edit.touched()) == euler;
}

constexpr const char* kRepeats = "every filling would repeat an edge of the surface";
constexpr const char* kNoManifold = "the filling would not be a manifold";
constexpr const char* kCrosses = "every filling would cross the surface";

struct Attempt {
  int growth;
  std::size_t side;
  FillWeight weight;
  bool refine;
};

std::vector<Attempt> attempts_for(std::size_t size) {
  std::vector<Attempt> attempts;
  for (int growth = 0; growth <= kMostGrowth; ++growth)
    for (const bool refine : {true, false})
      for (const FillWeight weight : {FillWeight::kArea, FillWeight::kAngle})
        for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
          if (refine || size > kWideRim - 4) attempts.push_back({growth, side, weight, refine});
  return attempts;
}

void note_result(const PatchEdit& edit, Cut& cut) {
  cut.removed = edit.removed_count();
  cut.added = edit.added_count();
  cut.volume = edit.volume();
}

Cut not_done(std::string why) {
  Cut cut;
  cut.why = std::move(why);
  return cut;
}

// Whether the curve could be much shorter: it has some edges, and every second vertex is much nearer than along them.
bool is_crooked(const EditablePatch& patch, std::span<const std::uint32_t> curve) {
  constexpr std::size_t kSomeEdges = 8;
  constexpr double kMostStraight = 0.9;  // a circle of eight edges has 0.92
  if (curve.size() < kSomeEdges) return false;
  double edges = 0, chords = 0;
  const std::size_t n = curve.size();
  for (std::size_t i = 0; i < n; ++i) {
    edges += distance(patch.position(curve[i]), patch.position(curve[(i + 1) % n]));
    chords += distance(patch.position(curve[i]), patch.position(curve[(i + 2) % n])) / 2;
  }
  return chords < kMostStraight * edges;
}

bool is_on_surface(const EditablePatch& patch, std::span<const std::uint32_t> curve) {
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (!patch.has_edge(curve[i], curve[(i + 1) % curve.size()])) return false;
  return curve.size() >= 3;
}

// `split`: what was done for this.
Cut try_cut(EditablePatch& patch, std::span<const std::uint32_t> curve, const CutOptions& options,
            const PatchSplit* split) {
  if (!is_on_surface(patch, curve)) return not_done("an earlier repair changed the surface at its curve");
  if (curve.size() > kMostRimVertices)
    return not_done("its curve has more than " + std::to_string(kMostRimVertices) + " edges");
  const auto sides = sides_of(patch, curve);
  if (!sides) {
    Cut cut = not_done("the surface is not an oriented manifold at its curve");
    cut.too_small = !std::ranges::all_of(curve, [&](std::uint32_t v) { return patch.vertex(v).whole; });
    return cut;
  }
  std::string why = "there is no room for a band beside its curve";
  bool too_small = false;
  std::optional<Attempt> folded;  // the first attempt whose only fault is that it folds
  const auto succeeds = [&](const Attempt& attempt, bool may_fold, Cut& cut) {
    CurveBand band(patch, curve, (*sides)[attempt.side], (*sides)[1 - attempt.side]);
    for (int ring = 0; ring < attempt.growth; ++ring) band.grow();
    cut.first_side.assign(curve.begin(), curve.end());
    cut.second_side = band.close_rim();
    if (cut.second_side.empty()) return false;
    PatchEdit edit(patch, options.float32, split);
    PatchNumbers before = edit.touched();
    for (const std::uint32_t v : corners_of(patch, band.triangles())) before.push_back(v);
    make_set(before);
    if (!std::ranges::all_of(before, [&](std::uint32_t v) { return patch.vertex(v).whole; })) {
      too_small = true;
      return false;
    }
    const std::int64_t euler = euler_among(patch, before);
    edit.remove(band.triangles());
    const auto fails = [&](const char* fault) {
      why = fault;
      edit.undo();
      return false;
    };
    if (!edit.fill(cut.first_side, attempt.weight, attempt.refine) ||
        !edit.fill(cut.second_side, attempt.weight, attempt.refine))
      return fails(kRepeats);
    if (!is_manifold(patch, edit, before, euler + 2)) return fails(kNoManifold);
    const bool folds = !may_fold && edit.folds();
    if ((folds && folded) || edit.crosses()) return fails(kCrosses);
    if (folds) {
      folded = attempt;
      return fails(kCrosses);
    }
    cut.done = true;
    note_result(edit, cut);
    cut.connected = are_connected(patch, cut.first_side, cut.second_side);
    return true;
  };
  for (const Attempt& attempt : attempts_for(curve.size()))
    if (Cut cut; succeeds(attempt, false, cut)) return cut;
  if (folded)
    if (Cut cut; succeeds(*folded, true, cut)) return cut;
  Cut cut = not_done(why);
  cut.too_small = too_small;
  return cut;
}

}  // namespace

Cut cut_along(EditablePatch& patch, std::span<const std::uint32_t> curve, const CutOptions& options) {
  constexpr double kMuchShorter = 0.85;
  const bool whole = std::ranges::all_of(curve, [&](std::uint32_t v) { return patch.vertex(v).whole; });
  const bool can_divide = whole && is_on_surface(patch, curve) && sides_of(patch, curve);
  const auto cut_tight = [&](double most) {
    const auto tight = pull_tight(patch, curve, most, options.float32);
    if (!tight) return Cut{};
    Cut cut = try_cut(patch, tight->curve, options, &tight->split);
    if (!cut.done) undo_split(patch, tight->split);
    return cut;
  };
  if (can_divide && is_crooked(patch, curve))
    if (Cut cut = cut_tight(kMuchShorter); cut.done) return cut;
  Cut plain = try_cut(patch, curve, options, nullptr);
  if (plain.done || plain.too_small || !can_divide) return plain;
  const PatchSplit split = make_room(patch, {curve.begin(), curve.end()}, options.float32);
  Cut roomy = try_cut(patch, curve, options, &split);
  if (roomy.done) return roomy;
  undo_split(patch, split);
  plain.too_small = roomy.too_small;
  if (Cut cut = cut_tight(1); cut.done) return cut;
  return plain;
}

Cut close_boundary(EditablePatch& patch, std::span<const std::uint32_t> rim, const CutOptions& options) {
  const PatchNumbers path(rim.begin(), rim.end());
  if (path.size() > kMostRimVertices)
    return not_done("it has more than " + std::to_string(kMostRimVertices) + " edges");
  if (!std::ranges::all_of(path, [&](std::uint32_t v) { return patch.vertex(v).whole; })) {
    Cut cut = not_done("the triangles around it are too large");
    cut.too_small = true;
    return cut;
  }
  std::string why = kRepeats;
  for (const bool refine : {true, false})
    for (const FillWeight weight : {FillWeight::kArea, FillWeight::kAngle}) {
      if (!refine && path.size() <= kWideRim) continue;
      PatchEdit edit(patch, options.float32);
      PatchNumbers touched = path;
      make_set(touched);
      const std::int64_t euler = euler_among(patch, touched);
      if (edit.fill(path, weight, refine)) {
        if (!is_manifold(patch, edit, touched, euler + 1)) {
          why = kNoManifold;
        } else if (edit.crosses()) {
          why = kCrosses;
        } else {
          Cut cut;
          cut.done = cut.connected = true;
          note_result(edit, cut);
          return cut;
        }
      }
      edit.undo();
    }
  return not_done(why);
}

}  // namespace reeb
