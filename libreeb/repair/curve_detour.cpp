#include "libreeb/repair/curve_detour.h"

#include "libreeb/base/vector3.h"
#include "libreeb/repair/shortest_paths.h"

namespace reeb {
namespace {

using Vertices = std::vector<std::uint32_t>;

}  // namespace

std::vector<std::uint32_t> with_detours(const EditablePatch& patch, std::span<const std::uint32_t> curve) {
  constexpr double kMostDetour = 1.5;
  const auto length_of = [&](std::span<const std::uint32_t> path) {
    double sum = 0;
    for (std::size_t i = 0; i < path.size(); ++i)
      sum += distance(patch.position(path[i]), patch.position(path[(i + 1) % path.size()]));
    return sum;
  };
  const double most = kMostDetour * length_of(curve);
  Vertices left;
  for (const std::uint32_t v : curve)
    if (patch.is_used(v)) left.push_back(v);
  if (left.size() < 2) return {};
  std::vector<std::uint8_t> taken(patch.vertex_count(), 0);
  for (const std::uint32_t v : left) taken[v] = 1;
  Vertices result;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const std::uint32_t from = left[i], to = left[(i + 1) % left.size()];
    result.push_back(from);
    if (patch.has_edge(from, to)) continue;
    const auto is_free = [&](std::uint32_t v) { return taken[v] == 0 || v == to; };
    const ShortestPaths paths(patch, from, most, is_free, to);
    if (!paths.reaches(to)) return {};
    const Vertices way = paths.path_to(to);
    for (const std::uint32_t v : way) taken[v] = 1;
    result.insert(result.end(), way.begin() + 1, way.end() - 1);
  }
  return result.size() >= 3 && length_of(result) <= most ? result : Vertices{};
}

}  // namespace reeb
