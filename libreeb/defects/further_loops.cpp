#include "libreeb/defects/further_loops.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "libreeb/containers/union_find.h"
#include "libreeb/defects/curve_relations.h"

namespace reeb {
namespace {

struct PathTree {
  std::vector<double> distance;
  std::vector<std::uint32_t> edge;  // towards the root
};

PathTree shortest_paths(const SurfacePatch& patch, std::uint32_t root) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PathTree tree{std::vector<double>(patch.vertex_count(), kFar),
                std::vector<std::uint32_t>(patch.vertex_count(), SurfacePatch::kNone)};
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> nearest;
  tree.distance[root] = 0;
  nearest.emplace(0, root);
  while (!nearest.empty()) {
    const auto [distance, v] = nearest.top();
    nearest.pop();
    if (distance > tree.distance[v]) continue;
    for (const std::uint32_t e : patch.edges_at(v)) {
      const SurfacePatch::Edge& edge = patch.edge(e);
      const std::uint32_t to = edge.a == v ? edge.b : edge.a;
      if (!(distance + edge.length < tree.distance[to])) continue;
      tree.distance[to] = distance + edge.length;
      tree.edge[to] = e;
      nearest.emplace(tree.distance[to], to);
    }
  }
  return tree;
}

// The vertices from this one to the root.
std::vector<std::uint32_t> way_to_root(const SurfacePatch& patch, const PathTree& tree, std::uint32_t v) {
  std::vector<std::uint32_t> way = {v};
  while (tree.edge[v] != SurfacePatch::kNone) {
    const SurfacePatch::Edge& edge = patch.edge(tree.edge[v]);
    v = edge.a == v ? edge.b : edge.a;
    way.push_back(v);
  }
  return way;
}

// The edge, and the ways from its ends to where they meet.
ClosedPath loop_of(const SurfacePatch& patch, const PathTree& tree, std::uint32_t e) {
  const SurfacePatch::Edge& edge = patch.edge(e);
  std::vector<std::uint32_t> first = way_to_root(patch, tree, edge.a), second = way_to_root(patch, tree, edge.b);
  while (first.size() > 1 && second.size() > 1 && first[first.size() - 2] == second[second.size() - 2]) {
    first.pop_back();
    second.pop_back();
  }
  ClosedPath path;
  path.length = edge.length + tree.distance[edge.a] + tree.distance[edge.b] - 2 * tree.distance[first.back()];
  path.vertices.assign(first.rbegin(), first.rend());
  path.vertices.insert(path.vertices.end(), second.begin(), second.end() - 1);
  return path;
}

}  // namespace

bool is_closed_surface(const SurfacePatch& patch) {
  for (std::uint32_t e = 0; e < patch.edge_count(); ++e)
    if (patch.triangles_at_edge(e).size() != 2 || !patch.consistent(e)) return false;
  return patch.edge_count() != 0;
}

std::vector<ClosedPath> loop_system(const SurfacePatch& patch, std::uint32_t root) {
  const PathTree tree = shortest_paths(patch, root);
  std::vector<std::uint8_t> in_tree(patch.edge_count(), 0);
  for (const std::uint32_t e : tree.edge)
    if (e != SurfacePatch::kNone) in_tree[e] = 1;
  std::vector<std::pair<double, std::uint32_t>> others;
  for (std::uint32_t e = 0; e < patch.edge_count(); ++e) {
    const SurfacePatch::Edge& edge = patch.edge(e);
    if (in_tree[e] == 0) others.emplace_back(tree.distance[edge.a] + tree.distance[edge.b] + edge.length, e);
  }
  // A tree of triangles that crosses the edges with the longest loops. The edges that are in neither tree are left.
  std::sort(others.begin(), others.end(), std::greater<>());
  UnionFind part(patch.triangle_count());
  std::vector<ClosedPath> loops;
  for (const auto& [length, e] : others) {
    const auto sides = patch.triangles_at_edge(e);
    if (!part.unite(sides[0], sides[1])) loops.push_back(loop_of(patch, tree, e));
  }
  return loops;
}

std::vector<ClosedPath> further_loops(const SurfacePatch& patch, std::span<const ClosedPath> known, std::size_t most,
                                      std::uint32_t roots) {
  std::vector<ClosedPath> loops;
  const std::uint32_t step = std::max(patch.vertex_count() / std::max(roots, 1u), 1u);
  for (std::uint32_t root = 0; root < patch.vertex_count(); root += step)
    for (ClosedPath& loop : loop_system(patch, root)) loops.push_back(std::move(loop));
  std::stable_sort(loops.begin(), loops.end(),
                   [](const ClosedPath& a, const ClosedPath& b) { return a.length < b.length; });
  std::vector<ClosedPath> all(known.begin(), known.end());
  for (std::size_t i = 0; i < loops.size() && all.size() < known.size() + most; ++i)
    if (!depends_on(patch, loops[i], all)) all.push_back(std::move(loops[i]));
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(known.size()));
  return all;
}

}  // namespace reeb
