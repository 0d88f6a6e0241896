#include "ooc/patches/collected_patches.h"

#include <algorithm>
#include <utility>

namespace reeb::ooc {
namespace {

constexpr const char* kPatchOwner = "patches that are repaired";

}  // namespace

CollectedPatches::CollectedPatches(std::span<const Ball> balls, std::span<const std::uint32_t> patch_of,
                                   std::vector<std::uint32_t> first_of_group, const io::TempDir& temp,
                                   MemoryBudget& budget)
    : budget_(&budget),
      grid_(balls),
      patch_of_ball_(patch_of.begin(), patch_of.end()),
      first_of_group_(std::move(first_of_group)),
      vertices_(kPatchOwner, temp, budget, first_of_group_.size() - 1),
      triangles_(kPatchOwner, temp, budget, first_of_group_.size() - 1),
      others_(first_of_group_.size() - 1, 0),
      memory_(budget.reserve(kPatchOwner, 100 * balls.size())) {
  for (std::size_t g = 0; g + 1 < first_of_group_.size(); ++g)
    group_of_patch_.resize(first_of_group_[g + 1], static_cast<std::uint16_t>(g));
}

void CollectedPatches::add(const MeshBatch& batch) {
  for (std::size_t i = 0; i < batch.vertex_count; ++i) {
    const Point point = batch.position(i);
    const std::uint32_t ball = grid_->find(point);
    if (ball == BallGrid::kNone) continue;
    const std::uint64_t vertex = batch.first_vertex.value() + i;
    const std::uint32_t patch = patch_of_ball_[ball];
    vertices_.append(group_of_patch_[patch], {vertex, point, set_.size(), patch});
    group_of_.push_back(group_of_patch_[patch]);
    set_.add(VertexId(vertex));
  }
  mesh_vertices_ += batch.vertex_count;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < batch.simplices[k].size(); i += k + 1)
      add_use(std::span(batch.simplices[k]).subspan(i, k + 1));
  const auto& corners = batch.triangles();
  for (std::size_t i = 0; i < corners.size(); i += 3, ++mesh_triangles_) add_use(std::span(corners).subspan(i, 3));
  memory_.resize(100 * patch_of_ball_.size() + set_.memory_bytes() + 2 * group_of_.capacity());
}

void CollectedPatches::add_use(std::span<const VertexId> corners) {
  Triangle triangle{{VertexSet::kNone, VertexSet::kNone, VertexSet::kNone}, Triangle::kPointOrEdge, mesh_triangles_};
  for (std::size_t k = 0; k < corners.size(); ++k) triangle.corners[k] = set_.find(corners[k]);
  const auto& [x, y, z] = triangle.corners;
  // Most triangles of a large mesh are in no ball.
  if ((x & y & z) == VertexSet::kNone) return;
  if (corners.size() == 3)
    triangle.kind = corners[0] != corners[1] && corners[1] != corners[2] && corners[0] != corners[2]
                        ? Triangle::kPlain
                        : Triangle::kDegenerate;
  for (std::size_t k = 0; k < 3; ++k) {
    if (triangle.corners[k] == VertexSet::kNone) continue;
    const std::uint16_t group = group_of_[triangle.corners[k]];
    bool has_it = false;
    for (std::size_t j = 0; j < k; ++j)
      has_it = has_it || (triangle.corners[j] != VertexSet::kNone && group_of_[triangle.corners[j]] == group);
    if (has_it) continue;
    triangles_.append(group, triangle);
    others_[group] += triangle.kind == Triangle::kPlain ? 0u : 1u;
  }
}

void CollectedPatches::finish() {
  grid_.reset();
  std::vector<std::uint32_t>().swap(patch_of_ball_);
  std::vector<std::uint16_t>().swap(group_of_);
  std::vector<std::uint16_t>().swap(group_of_patch_);
  set_ = {};
  memory_.resize(0);
}

// A group while it is put together.
struct CollectedPatches::Filling {
  PatchGroup group;
  std::uint32_t first;  // patch of the group
  VertexSet numbers{};  // its vertices, by their numbers of all groups
  std::vector<std::uint32_t> patch_of{}, triangle_patch{}, line_patch{};  // in the group

  void add(const CollectedPatches::Vertex& vertex) {
    numbers.add(VertexId(vertex.number));
    group.vertices_.push_back({VertexId(vertex.id), vertex.position});
    patch_of.push_back(vertex.patch - first);
  }

  void add(CollectedPatches::Triangle triangle) {
    for (std::uint32_t& v : triangle.corners)
      if (v != VertexSet::kNone) v = numbers.find(VertexId(v));
    if (triangle.kind == Triangle::kPlain)
      add_plain(triangle);
    else
      add_other(triangle);
  }

  void add_plain(const CollectedPatches::Triangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    if (in_one_patch(a, b) && in_one_patch(a, c)) {
      group.triangles_.push_back({triangle.corners, triangle.id});
      triangle_patch.push_back(patch_of[a]);
      return;
    }
    for (const std::uint32_t v : triangle.corners)
      if (v != VertexSet::kNone) group.vertices_[v].whole = false;
  }

  // Degenerate triangles, edges and points.
  void add_other(const CollectedPatches::Triangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    const bool is_degenerate = triangle.kind == Triangle::kDegenerate;
    const std::uint32_t other = is_degenerate && a == b ? c : b;
    const bool is_line = a != other && in_one_patch(a, other);
    if (is_line) {
      group.lines_.push_back({{a, other}, is_degenerate ? triangle.id : EditablePatch::kAdded});
      line_patch.push_back(patch_of[a]);
    }
    if (is_line && is_degenerate) return;  // it can be removed
    for (const std::uint32_t v : triangle.corners)
      if (v != VertexSet::kNone) group.vertices_[v].used_elsewhere = true;
  }

  bool in_one_patch(std::uint32_t v, std::uint32_t w) const {
    return v != VertexSet::kNone && w != VertexSet::kNone && patch_of[v] == patch_of[w];
  }

  void sort_by_patch(std::uint32_t patches) {
    group.vertices_of_ = by_patch(patches, patch_of);
    group.triangles_of_ = by_patch(patches, triangle_patch);
    group.lines_of_ = by_patch(patches, line_patch);
  }

  static PatchGroup::ByPatch by_patch(std::uint32_t patches, const std::vector<std::uint32_t>& of) {
    PatchGroup::ByPatch sorted;
    sorted.first.assign(patches + 1, 0);
    for (const std::uint32_t patch : of) ++sorted.first[patch + 1];
    for (std::size_t p = 0; p < patches; ++p) sorted.first[p + 1] += sorted.first[p];
    sorted.order.resize(of.size());
    std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
    for (std::uint32_t i = 0; i < of.size(); ++i) sorted.order[next[of[i]]++] = i;
    return sorted;
  }
};

PatchGroup CollectedPatches::group(std::size_t number) {
  const auto vertex_count = static_cast<std::size_t>(vertices_.count(number)),
             all_count = static_cast<std::size_t>(triangles_.count(number)), other_count = others_[number],
             triangle_count = all_count - other_count;
  Filling filling{.group = {}, .first = first_of_group_[number]};
  PatchGroup& group = filling.group;
  group.memory_ = budget_->reserve(kPatchOwner, vertex_count * (sizeof(PatchGroup::Vertex) + 12) +
                                                    triangle_count * (sizeof(PatchGroup::Triangle) + 4) +
                                                    other_count * (sizeof(PatchGroup::Line) + 4));
  group.vertices_.reserve(vertex_count);
  group.triangles_.reserve(triangle_count);
  group.lines_.reserve(other_count);
  vertices_.rewind(number);
  for (std::size_t i = 0; i < vertex_count; ++i) filling.add(vertices_.next(number));
  triangles_.rewind(number);
  for (std::size_t i = 0; i < all_count; ++i) filling.add(triangles_.next(number));
  filling.sort_by_patch(first_of_group_[number + 1] - filling.first);
  return std::move(group);
}

EditablePatch PatchGroup::patch(std::size_t number) const {
  const auto members = [number](const ByPatch& of) {
    return std::span(of.order).subspan(of.first[number], of.first[number + 1] - of.first[number]);
  };
  const std::span<const std::uint32_t> vertices = members(vertices_of_);
  const auto local = [&](std::uint32_t vertex) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(vertices, vertex) - vertices.begin());
  };
  EditablePatch patch;
  for (const std::uint32_t v : vertices) {
    const Vertex& vertex = vertices_[v];
    patch.add_vertex({vertex.id, vertex.position, vertex.whole, vertex.used_elsewhere, {}});
  }
  for (const std::uint32_t t : members(triangles_of_)) {
    const auto& [a, b, c] = triangles_[t].corners;
    patch.add_triangle({local(a), local(b), local(c)}, triangles_[t].id);
  }
  for (const std::uint32_t l : members(lines_of_)) {
    const auto& [a, b] = lines_[l].ends;
    patch.add_line({local(a), local(b), lines_[l].id});
  }
  return patch;
}

}  // namespace reeb::ooc
