#include "libreeb/defects/curve_relations.h"

#include <algorithm>
#include <compare>
#include <iterator>
#include <utility>

#include "libreeb/containers/union_find.h"

namespace reeb {
namespace {

// A sum of unknowns modulo 2 that must be 0 or 1; unknowns ascending.
struct Equation {
  std::vector<std::uint32_t> unknowns;
  bool one = false;
  friend auto operator<=>(const Equation&, const Equation&) = default;
};

void toggle(std::vector<std::uint32_t>& sorted, std::uint32_t x) {
  const auto it = std::lower_bound(sorted.begin(), sorted.end(), x);
  if (it != sorted.end() && *it == x)
    sorted.erase(it);
  else
    sorted.insert(it, x);
}

bool has_solution(std::vector<Equation> equations, std::uint32_t unknowns) {
  std::vector<std::uint32_t> row_of(unknowns, SurfacePatch::kNone);  // by the greatest unknown
  std::vector<Equation> rows;
  for (Equation& equation : equations) {
    while (!equation.unknowns.empty() && row_of[equation.unknowns.back()] != SurfacePatch::kNone) {
      const Equation& row = rows[row_of[equation.unknowns.back()]];
      std::vector<std::uint32_t> sum;
      std::set_symmetric_difference(equation.unknowns.begin(), equation.unknowns.end(), row.unknowns.begin(),
                                    row.unknowns.end(), std::back_inserter(sum));
      equation.unknowns = std::move(sum);
      equation.one ^= row.one;
    }
    if (equation.unknowns.empty()) {
      if (equation.one) return false;
      continue;
    }
    row_of[equation.unknowns.back()] = static_cast<std::uint32_t>(rows.size());
    rows.push_back(std::move(equation));
  }
  return true;
}

}  // namespace

bool bounds_with(const SurfacePatch& patch, std::span<const std::uint32_t> curve,
                 std::span<const std::vector<std::uint32_t>> others) {
  // What each edge is on: other curves by number, and whether on the new one.
  std::vector<std::vector<std::uint32_t>> on(patch.edge_count());
  std::vector<std::uint8_t> on_new(patch.edge_count(), 0);
  for (std::uint32_t i = 0; i < others.size(); ++i)
    for (const std::uint32_t e : others[i]) toggle(on[e], i);
  for (const std::uint32_t e : curve) on_new[e] ^= 1;
  const auto is_wall = [&](std::uint32_t e) {
    return on_new[e] != 0 || !on[e].empty() || patch.triangles_at_edge(e).size() != 2;
  };
  UnionFind region(patch.triangle_count() + 1);
  const std::uint32_t outside = patch.triangle_count();
  for (std::uint32_t e = 0; e < patch.edge_count(); ++e) {
    const auto at = patch.triangles_at_edge(e);
    if (!is_wall(e)) region.unite(at[0], at[1]);
    // Triangles can be missing here, or there are none.
    if (at.size() == 1) region.unite(at[0], outside);
  }
  // Unknowns: whether each other curve takes part, then whether each region does.
  const auto curves = static_cast<std::uint32_t>(others.size());
  std::vector<Equation> equations;
  for (std::uint32_t e = 0; e < patch.edge_count(); ++e) {
    if (!is_wall(e)) continue;
    Equation equation{on[e], on_new[e] != 0};
    for (const std::uint32_t t : patch.triangles_at_edge(e))
      if (region.find(t) != region.find(outside)) toggle(equation.unknowns, curves + region.find(t));
    equations.push_back(std::move(equation));
  }
  std::sort(equations.begin(), equations.end());
  equations.erase(std::unique(equations.begin(), equations.end()), equations.end());
  return has_solution(std::move(equations), curves + patch.triangle_count() + 1);
}

std::vector<std::uint32_t> edges_of(const SurfacePatch& patch, const ClosedPath& path) {
  std::vector<std::uint32_t> edges;
  for (std::size_t i = 0; i < path.vertices.size(); ++i)
    edges.push_back(patch.edge_between(path.vertices[i], path.vertices[(i + 1) % path.vertices.size()]));
  return edges;
}

bool depends_on(const SurfacePatch& patch, const ClosedPath& path, std::span<const ClosedPath> others) {
  const std::vector<std::uint32_t> edges = edges_of(patch, path);
  std::vector<std::vector<std::uint32_t>> around;
  for (const ClosedPath& other : others) {
    if (const auto left = left_of(patch, other)) {
      std::size_t crossings = 0;
      for (const std::uint32_t e : edges) crossings += (*left)[e];
      if (crossings % 2 != 0) return true;
    }
    around.push_back(edges_of(patch, other));
  }
  return bounds_with(patch, edges, around);
}

}  // namespace reeb
