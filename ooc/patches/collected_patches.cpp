#include "ooc/patches/collected_patches.h"

#include <algorithm>

namespace reeb::ooc {

CollectedPatches::CollectedPatches(std::span<const Ball> balls, std::span<const std::uint32_t> patch_of,
                                   std::size_t patches, MemoryBudget& budget)
    : grid_(balls),
      patch_of_(patch_of.begin(), patch_of.end()),
      vertex_first_(patches + 1, 0),
      triangle_first_(patches + 1, 0),
      memory_(budget.reserve("patches that are repaired", 0)) {}

void CollectedPatches::add(const MeshBatch& batch) {
  for (std::size_t i = 0; i < batch.vertex_count; ++i) {
    Point point{};
    for (std::size_t k = 0; k < std::min<std::size_t>(3, batch.coordinates.size()); ++k)
      point[k] = batch.coordinates[k][i];
    const std::uint32_t ball = grid_.find(point);
    if (ball == BallGrid::kNone) continue;
    const VertexId vertex(batch.first_vertex.value() + i);
    set_.add(vertex);
    vertices_.push_back(vertex);
    positions_.push_back(point);
    patch_.push_back(patch_of_[ball]);
    whole_.push_back(1);
    used_elsewhere_.push_back(0);
  }
  mesh_vertices_ += batch.vertex_count;
  for (const VertexId v : batch.points()) use(v);
  for (const VertexId v : batch.edges()) use(v);
  const auto& corners = batch.triangles();
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    add_triangle(corners[i], corners[i + 1], corners[i + 2]);
    ++mesh_triangles_;
  }
  memory_.resize(set_.memory_bytes() + vertices_.capacity() * (8 + 24 + 4 + 2) +
                 triangles_.capacity() * sizeof(Triangle) + triangles_.size() * 4 + vertices_.size() * 4);
}

void CollectedPatches::use(VertexId v) {
  if (const std::uint32_t x = set_.find(v); x != VertexSet::kNone) used_elsewhere_[x] = 1;
}

void CollectedPatches::add_triangle(VertexId a, VertexId b, VertexId c) {
  const std::array corners = {set_.find(a), set_.find(b), set_.find(c)};
  const auto is_absent = [](std::uint32_t v) { return v == VertexSet::kNone; };
  if (std::ranges::all_of(corners, is_absent)) return;
  if (a == b || b == c || a == c) {
    for (const VertexId v : {a, b, c}) use(v);
    return;
  }
  if (std::ranges::none_of(corners, is_absent) && patch_[corners[0]] == patch_[corners[1]] &&
      patch_[corners[0]] == patch_[corners[2]]) {
    triangles_.push_back({corners, mesh_triangles_});
    return;
  }
  for (const std::uint32_t v : corners)
    if (!is_absent(v)) whole_[v] = 0;
}

void CollectedPatches::finish() {
  const auto group = [](std::size_t count, auto patch_of, std::vector<std::uint32_t>& first,
                        std::vector<std::uint32_t>& order) {
    for (std::uint32_t i = 0; i < count; ++i) ++first[patch_of(i) + 1];
    for (std::size_t p = 0; p + 1 < first.size(); ++p) first[p + 1] += first[p];
    order.resize(count);
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t i = 0; i < count; ++i) order[next[patch_of(i)]++] = i;
  };
  group(
      vertices_.size(), [&](std::uint32_t v) { return patch_[v]; }, vertex_first_, vertex_order_);
  group(
      triangles_.size(), [&](std::uint32_t t) { return patch_[triangles_[t].corners[0]]; }, triangle_first_,
      triangle_order_);
}

EditablePatch CollectedPatches::patch(std::size_t number) const {
  EditablePatch patch;
  const auto first = vertex_order_.begin() + vertex_first_[number],
             end = vertex_order_.begin() + vertex_first_[number + 1];
  for (auto it = first; it != end; ++it)
    patch.add_vertex({vertices_[*it], positions_[*it], whole_[*it] != 0, used_elsewhere_[*it] != 0, {}});
  for (std::uint32_t i = triangle_first_[number]; i < triangle_first_[number + 1]; ++i) {
    const Triangle& triangle = triangles_[triangle_order_[i]];
    EditablePatch::Corners local{};
    for (std::size_t k = 0; k < 3; ++k)
      local[k] = static_cast<std::uint32_t>(std::lower_bound(first, end, triangle.corners[k]) - first);
    patch.add_triangle(local, triangle.id);
  }
  return patch;
}

}  // namespace reeb::ooc
