#include "tools/defects/component_tops.h"

#include <limits>
#include <span>

#include "libreeb/base/error.h"
#include "libreeb/containers/flat_map.h"
#include "libreeb/containers/union_find.h"

namespace reeb::tools {

std::vector<SettledNode> component_tops(const ValuedMesh& mesh, const LoopFunction& function, std::size_t number,
                                        MemoryBudget& budget) {
  const bool several = function.components > 1;
  // Vertices of an image may be left out, so indices are not below their number.
  const std::uint64_t bound = mesh.info().grid ? mesh.info().grid->vertex_count() : function.mesh.vertices;
  const Reservation memory = budget.reserve("components of the mesh", several ? 4 * bound : 0);
  UnionFind component(several ? static_cast<std::uint32_t>(bound) : 0);
  if (several)
    mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t, std::uint64_t) {
      if (batch.first_vertex.value() + batch.vertex_count > bound) throw input_changed();
      for (std::size_t k = 1; k < batch.simplices.size(); ++k)
        for (std::size_t i = 0; i < batch.simplices[k].size(); ++i)
          if (i % (k + 1) != 0)
            component.unite(static_cast<std::uint32_t>(batch.simplices[k][i - 1].value()),
                            static_cast<std::uint32_t>(batch.simplices[k][i].value()));
    });
  FlatMap number_of;  // by the root
  for (std::uint32_t c = 0; several && c < function.tops.size(); ++c)
    number_of.find_or_insert(component.find(static_cast<std::uint32_t>(function.tops[c].key.vertex.value())), c);
  std::vector<SettledNode> tops = function.tops;
  std::vector<double> most(tops.size(), -std::numeric_limits<double>::infinity());
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>> values, std::uint64_t, std::uint64_t) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      const VertexId vertex(batch.first_vertex.value() + i);
      const std::uint32_t c =
          several ? number_of.find(component.find(static_cast<std::uint32_t>(vertex.value()))) : std::uint32_t{0};
      if (c == FlatMap::kNone || batch.coordinates[0][i] <= most[c]) continue;
      most[c] = batch.coordinates[0][i];
      tops[c].key = {values[number][i], vertex};
      tops[c].position = batch.position(i);
    }
  });
  return tops;
}

}  // namespace reeb::tools
