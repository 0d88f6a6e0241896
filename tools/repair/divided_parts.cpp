#include "tools/repair/divided_parts.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "ooc/tables/paged_union_find.h"

namespace reeb::tools {
namespace {

// For 3 million vertices, which are more than a coherent order of triangles has in use at a time.
constexpr std::uint64_t kMostResidentBytes = 24u << 20;

}  // namespace

std::vector<std::pair<std::uint32_t, std::string>> dividing_curves(
    const ValuedMesh& mesh, const MeshEdits& edits, std::uint64_t mesh_vertices, const std::vector<RimPair>& pairs,
    ooc::Workspace& space, const std::function<void(std::uint64_t done, std::uint64_t total)>& progress) {
  std::vector<std::pair<std::uint32_t, std::string>> result;
  ooc::PagedUnionFind part("parts of the repaired surface", space.temp, space.budget,
                           std::min(space.share(), kMostResidentBytes));
  const auto number = [&](const VertexRef& ref) { return ref.is_new ? mesh_vertices + ref.number : ref.number; };
  std::uint64_t triangle = 0;
  auto removed = edits.removed.begin();
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
    const auto& corners = batch.triangles();
    for (std::size_t i = 0; i < corners.size(); i += 3, ++triangle) {
      if (removed != edits.removed.end() && *removed == triangle) {
        ++removed;
        continue;
      }
      part.unite(corners[i].value(), corners[i + 1].value());
      part.unite(corners[i].value(), corners[i + 2].value());
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
