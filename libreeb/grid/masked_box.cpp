#include "libreeb/grid/masked_box.h"

#include <bit>
#include <optional>
#include <utility>

#include "libreeb/grid/grid_division.h"
#include "libreeb/grid/neighbour_groups.h"

namespace reeb {
namespace {

using Place = std::array<std::uint64_t, 3>;

// A part of the layer, with both ends.
struct Cuboid {
  Place first{}, last{};
};

Cuboid cuboid_of(const LayerBox& box) {
  Cuboid cuboid{box.first, box.first};
  for (std::size_t k = 0; k < 3; ++k) cuboid.last[k] += box.size[k] - 1;
  return cuboid;
}

template <class Visit>
void for_each_place(const Cuboid& cuboid, const Visit& visit) {
  for (std::uint64_t k = cuboid.first[2]; k <= cuboid.last[2]; ++k)
    for (std::uint64_t j = cuboid.first[1]; j <= cuboid.last[1]; ++j)
      for (std::uint64_t i = cuboid.first[0]; i <= cuboid.last[0]; ++i) visit(Place{i, j, k});
}

// The neighbours that are a step up an axis, or down.
constexpr std::array<std::array<NeighbourSet, 2>, 3> make_sides() {
  std::array<std::array<NeighbourSet, 2>, 3> sides{};
  for (unsigned n = 0; n < kNeighbours; ++n)
    for (std::size_t k = 0; k < 3; ++k)
      if (const int step = step_to(n)[k]; step != 0) {
        NeighbourSet& side = sides[k][step > 0 ? 1 : 0];
        side = static_cast<NeighbourSet>(side | 1u << n);
      }
  return sides;
}

struct LowerAndUpper {
  NeighbourSet lower = 0, upper = 0;
};

// A function on a layer.
class LayerFunction {
 public:
  LayerFunction(const MaskedLayer& layer, std::span<const double> values) : layer_(layer), values_(values) {
    for (unsigned n = 0; n < kNeighbours; ++n) {
      const auto step = step_to(n);
      offsets_[n] = step[0] + static_cast<std::int64_t>(layer.size[0]) *
                                  (step[1] + static_cast<std::int64_t>(layer.size[1]) * step[2]);
    }
  }

  // Of the neighbours in the cuboid: which are below the vertex, and which are above. Equal values are in the order of
  // their vertices.
  LowerAndUpper neighbours(const Cuboid& within, const Place& at) const {
    static constexpr auto kSides = make_sides();
    unsigned left = (1u << kNeighbours) - 1;
    for (std::size_t k = 0; k < 3; ++k) {
      if (at[k] == within.first[k]) left &= ~unsigned{kSides[k][0]};
      if (at[k] == within.last[k]) left &= ~unsigned{kSides[k][1]};
    }
    const std::uint64_t v = layer_.index(at);
    const double here = values_[v];
    LowerAndUpper sets;
    for (; left != 0; left &= left - 1) {
      const auto n = static_cast<unsigned>(std::countr_zero(left));
      const double there = values_[v + static_cast<std::uint64_t>(offsets_[n])];
      const bool is_up = n < kNeighbours / 2;
      if (there > here || (there == here && is_up))
        sets.upper = static_cast<NeighbourSet>(sets.upper | 1u << n);
      else if (there < here || there == here)
        sets.lower = static_cast<NeighbourSet>(sets.lower | 1u << n);
    }
    return sets;
  }

 private:
  const MaskedLayer& layer_;
  std::span<const double> values_;
  std::array<std::int64_t, kNeighbours> offsets_{};
};

bool is_one_group(NeighbourSet set) { return std::has_single_bit(groups_of_sets()[set]); }
bool is_regular(const LowerAndUpper& sets) { return is_one_group(sets.lower) && is_one_group(sets.upper); }

std::optional<Cuboid> face_of(const LayerBox& box, std::size_t axis, bool high) {
  if ((box.shared & (high ? high_face(axis) : low_face(axis))) == 0) return std::nullopt;
  Cuboid face = cuboid_of(box);
  (high ? face.first : face.last)[axis] = (high ? face.last : face.first)[axis];
  return face;
}

// Marks the vertices of a face that are not regular in it, and on a rising path from each of them into each group of
// its upper neighbours. A path ends at the next vertex that is not regular. Each contour of the face meets one of these
// paths: it was born, or came from another contour, at such a vertex, and contains the first edges of its paths.
void mark_paths(const MaskedLayer& layer, const LayerFunction& function, const Cuboid& face,
                std::vector<std::uint8_t>& shared) {
  for_each_place(face, [&](const Place& start) {
    if (!layer.has(layer.index(start))) return;
    const LowerAndUpper around = function.neighbours(face, start);
    if (is_regular(around)) return;
    shared[layer.index(start)] = 1;
    for (unsigned left = groups_of_sets()[around.upper]; left != 0; left &= left - 1) {
      Place at = start;
      for (unsigned next = left;;) {
        const auto step = step_to(static_cast<unsigned>(std::countr_zero(next)));
        for (std::size_t k = 0; k < 3; ++k) at[k] += static_cast<std::uint64_t>(static_cast<std::int64_t>(step[k]));
        shared[layer.index(at)] = 1;
        const LowerAndUpper sets = function.neighbours(face, at);
        if (!is_regular(sets)) break;
        next = sets.upper;
      }
    }
  });
}

}  // namespace

// The common face of two boxes is the high face of the one that comes first. It has the same vertices in both.
void mark_shared_vertices(const MaskedLayer& layer, std::span<const LayerBox> boxes,
                          std::vector<std::uint8_t>& shared) {
  for (const std::span<const double> values : layer.values) {
    const LayerFunction function(layer, values);
    for (const LayerBox& box : boxes) {
      const Cuboid all = cuboid_of(box);
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
          const std::optional<Cuboid> face = face_of(box, axis, high);
          if (!face) continue;
          for_each_place(*face, [&](const Place& at) {
            const std::uint64_t v = layer.index(at);
            if (layer.has(v) && shared[v] == 0 && !is_regular(function.neighbours(all, at))) shared[v] = 1;
          });
          if (high) mark_paths(layer, function, *face, shared);
        }
    }
  }
}

MaskedBoxes::MaskedBoxes(const GridSize& grid) {
  unsigned axes = 0;
  for (std::size_t k = 0; k < 3; ++k) axes |= static_cast<unsigned>(grid[k] > 1) << k;
  for (const GridSimplex& simplex : grid_simplices(static_cast<std::uint8_t>(axes), 2)) {
    if (simplex.corner_count == 3)
      triangles_.push_back({step_along(simplex.corners[1], 1), step_along(simplex.corners[2], 1)});
    if (simplex.corner_count != 2) continue;
    Edge edge{step_along(simplex.corners[1], 1), {}};
    for (const GridStep& step : steps_to_cofaces(simplex, static_cast<std::uint8_t>(axes))) {
      const Step up = step_along(step.up, 1), down = step_along(step.down, -1);
      edge.apexes.push_back({up[0] + down[0], up[1] + down[1], up[2] + down[2]});
    }
    edges_.push_back(std::move(edge));
  }
}

void MaskedBoxes::fill(const MaskedLayer& layer, const LayerBox& box, std::span<const std::uint8_t> shared,
                       Chunk& chunk, std::vector<std::uint64_t>& from) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  chunk.clear();
  from.clear();
  local_.assign(std::size_t{box.size[0]} * box.size[1] * box.size[2], kNone);
  const Cuboid all = cuboid_of(box);
  std::size_t place = 0;
  for_each_place(all, [&](const Place& at) {
    const std::size_t here = place++;
    const std::uint64_t v = layer.index(at);
    if (!layer.has(v)) return;
    local_[here] = static_cast<std::uint32_t>(from.size());
    from.push_back(v);
    chunk.ids.emplace_back(layer.first_id + v);
    unsigned faces = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (at[k] == all.first[k]) faces |= low_face(k);
      if (at[k] == all.last[k]) faces |= high_face(k);
    }
    faces &= box.shared;
    const bool is_last = (faces & kHighFaces) == 0, is_first = (faces & ~unsigned{kHighFaces}) == 0;
    unsigned use = kUsedHereOnly;
    if (faces != 0 && shared[v] != 0)
      use = (is_first ? 0u : unsigned{kUsedEarlier}) | (is_last ? 0u : unsigned{kUsedLater});
    else if (!is_last)
      use = kCountedElsewhere;
    chunk.uses.push_back(static_cast<std::uint8_t>(use));
  });
  const auto [ni, nj, nk] = box.size;
  const auto vertex = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    if (i < 0 || j < 0 || k < 0 || i >= ni || j >= nj || k >= nk) return kNone;
    return local_[static_cast<std::size_t>(i + ni * (j + std::int64_t{nj} * k))];
  };
  for (std::int64_t k = 0; k < nk; ++k)
    for (std::int64_t j = 0; j < nj; ++j)
      for (std::int64_t i = 0; i < ni; ++i) {
        const std::uint32_t v = vertex(i, j, k);
        if (v == kNone) continue;
        const auto at = [&](const Step& step) { return vertex(i + step[0], j + step[1], k + step[2]); };
        for (const auto& [second, third] : triangles_) {
          const std::uint32_t b = at(second), c = at(third);
          if (b == kNone || c == kNone) continue;
          chunk.corners.insert(chunk.corners.end(), {v, b, c});
        }
        for (const Edge& edge : edges_) {
          const std::uint32_t end = at(edge.to);
          if (end == kNone) continue;
          bool has_triangle = false;
          for (const Step& apex : edge.apexes) has_triangle = has_triangle || at(apex) != kNone;
          if (!has_triangle) chunk.corners.insert(chunk.corners.end(), {v, end, end});
        }
      }
}

}  // namespace reeb
