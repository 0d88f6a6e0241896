#include "tools/repair/divided_parts.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>

#include "libreeb/base/union_find.h"

namespace reeb::tools {

std::vector<std::pair<std::uint32_t, std::string>> dividing_curves(
    const ValuedMesh& mesh, const MeshEdits& edits, std::uint64_t mesh_vertices, const std::vector<RimPair>& pairs,
    MemoryBudget& budget, const std::function<void(std::uint64_t done, std::uint64_t total)>& progress) {
  std::vector<std::pair<std::uint32_t, std::string>> result;
  const std::uint64_t all = mesh_vertices + edits.vertices.size();
  const Reservation memory = budget.try_reserve("parts of the repaired surface", sizeof(std::uint32_t) * all);
  if (all > std::numeric_limits<std::uint32_t>::max() / 2 || memory.bytes() == 0) {
    for (const RimPair& pair : pairs)
      result.emplace_back(pair.job, "whether cutting along it divides the surface cannot be told in this memory");
    return result;
  }
  UnionFind part(static_cast<std::uint32_t>(all));
  const auto number = [&](const VertexRef& ref) {
    return static_cast<std::uint32_t>(ref.is_new ? mesh_vertices + ref.number : ref.number);
  };
  std::uint64_t triangle = 0;
  auto removed = edits.removed.begin();
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
    const auto& corners = batch.triangles();
    for (std::size_t i = 0; i < corners.size(); i += 3, ++triangle) {
      if (removed != edits.removed.end() && *removed == triangle) {
        ++removed;
        continue;
      }
      const auto a = static_cast<std::uint32_t>(corners[i].value());
      part.unite(a, static_cast<std::uint32_t>(corners[i + 1].value()));
      part.unite(a, static_cast<std::uint32_t>(corners[i + 2].value()));
    }
    progress(done, total);
  });
  for (const auto& corners : edits.triangles) {
    part.unite(number(corners[0]), number(corners[1]));
    part.unite(number(corners[0]), number(corners[2]));
  }
  // A cut that joined the parts again is one too many: from the last one on.
  for (std::size_t i = pairs.size(); i-- > 0;) {
    const RimPair& pair = pairs[i];
    if (!pair.first || !pair.second || part.unite(number(*pair.first), number(*pair.second)))
      result.emplace_back(pair.job, "cutting along it would divide the surface");
  }
  return result;
}

}  // namespace reeb::tools
