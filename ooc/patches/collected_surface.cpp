#include "ooc/patches/collected_surface.h"

#include <algorithm>
#include <utility>

namespace reeb::ooc {

CollectedSurface::CollectedSurface(std::span<const Ball> balls, std::size_t functions, MemoryBudget& budget)
    : grid_(balls), values_(functions), memory_(budget.reserve("patches of loops", 0)) {}

void CollectedSurface::add(const MeshBatch& batch, std::span<const std::vector<double>> values) {
  for (std::size_t i = 0; i < batch.vertex_count; ++i) {
    Point point{};
    for (std::size_t k = 0; k < std::min<std::size_t>(3, batch.coordinates.size()); ++k)
      point[k] = batch.coordinates[k][i];
    if (!grid_.contains(point)) continue;
    const VertexId vertex(batch.first_vertex.value() + i);
    set_.add(vertex);
    vertices_.push_back(vertex);
    positions_.push_back(point);
    whole_.push_back(1);
    for (std::size_t f = 0; f < values_.size(); ++f) values_[f].push_back(values[f][i]);
  }
  for (std::size_t k = 2; k < batch.simplices.size(); ++k) {
    const auto& corners = batch.simplices[k];
    for (std::size_t s = 0; s < corners.size(); s += k + 1)
      for (std::size_t a = 0; a + 2 <= k; ++a)
        for (std::size_t b = a + 1; b + 1 <= k; ++b)
          for (std::size_t c = b + 1; c <= k; ++c) add_triangle(corners[s + a], corners[s + b], corners[s + c]);
  }
  memory_.resize(set_.memory_bytes() + vertices_.capacity() * (8 + 24 + 1 + 8 * values_.size()) +
                 triangles_.capacity() * 12 + vertices_.size() * 40);
}

void CollectedSurface::add_triangle(VertexId a, VertexId b, VertexId c) {
  const std::uint32_t x = set_.find(a), y = set_.find(b), z = set_.find(c);
  if (x == VertexSet::kNone && y == VertexSet::kNone && z == VertexSet::kNone) return;
  if (a == b || b == c || a == c) return;
  if (x != VertexSet::kNone && y != VertexSet::kNone && z != VertexSet::kNone) {
    triangles_.push_back({x, y, z});
    return;
  }
  for (const std::uint32_t v : {x, y, z})
    if (v != VertexSet::kNone) whole_[v] = 0;
}

void CollectedSurface::finish() {
  first_.assign(vertices_.size() + 1, 0);
  for (const auto& triangle : triangles_)
    for (const std::uint32_t v : triangle) ++first_[v + 1];
  for (std::size_t v = 0; v < vertices_.size(); ++v) first_[v + 1] += first_[v];
  at_.resize(3 * triangles_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (const std::uint32_t v : triangles_[t]) at_[next[v]++] = t;
}

double CollectedSurface::mean_edge() const {
  double sum = 0;
  for (const auto& [a, b, c] : triangles_)
    sum += distance(positions_[a], positions_[b]) + distance(positions_[b], positions_[c]) +
           distance(positions_[c], positions_[a]);
  return triangles_.empty() ? 0 : sum / (3 * static_cast<double>(triangles_.size()));
}

CollectedSurface::Patch CollectedSurface::cut(std::span<const VertexId> seeds, std::span<const Ball> balls,
                                              std::size_t most_vertices) const {
  FlatMap taken;
  std::vector<std::uint32_t> members, cut_off;
  bool limited = false;
  const auto take = [&](std::uint32_t v) {
    if (taken.find(v) != FlatMap::kNone) return true;
    if (std::ranges::none_of(balls, [&](const Ball& ball) { return ball.contains(positions_[v]); })) return false;
    if (members.size() >= most_vertices) {
      limited = true;
      return false;
    }
    taken.find_or_insert(v, 0);
    members.push_back(v);
    return true;
  };
  for (const VertexId seed : seeds)
    if (const std::uint32_t v = set_.find(seed); v != VertexSet::kNone) take(v);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::uint32_t member = members[i];
    bool all = true;
    for (std::uint32_t k = first_[member]; k < first_[member + 1]; ++k)
      for (const std::uint32_t v : triangles_[at_[k]])
        if (v != member && !take(v)) all = false;
    if (!all) cut_off.push_back(member);
  }
  std::sort(members.begin(), members.end());
  taken.clear();
  for (std::uint32_t i = 0; i < members.size(); ++i) taken.find_or_insert(members[i], i);

  PatchContent content;
  Patch patch{SurfacePatch({}), std::vector<std::vector<double>>(values_.size()), limited};
  for (const std::uint32_t v : members) {
    content.vertices.push_back(vertices_[v]);
    content.positions.push_back(positions_[v]);
    content.whole.push_back(whole_[v]);
    for (std::size_t f = 0; f < values_.size(); ++f) patch.values[f].push_back(values_[f][v]);
  }
  for (const std::uint32_t v : cut_off) content.whole[taken.find(v)] = 0;
  const auto corner_set = [](std::array<std::uint32_t, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  // Each triangle at its lowest corner.
  for (std::uint32_t i = 0; i < members.size(); ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(content.triangles.size());
    for (std::uint32_t k = first_[members[i]]; k < first_[members[i] + 1]; ++k) {
      const auto& corners = triangles_[at_[k]];
      if (std::ranges::min(corners) != members[i]) continue;
      std::array<std::uint32_t, 3> local{};
      for (std::size_t c = 0; c < 3; ++c) local[c] = corners[c] == members[i] ? i : taken.find(corners[c]);
      if (std::ranges::find(local, FlatMap::kNone) != local.end()) continue;
      // A repeated triangle changes nothing.
      if (std::none_of(content.triangles.begin() + begin, content.triangles.end(),
                       [&](const auto& other) { return corner_set(other) == corner_set(local); }))
        content.triangles.push_back(local);
    }
  }
  patch.surface = SurfacePatch(std::move(content));
  return patch;
}

}  // namespace reeb::ooc
