#include "tools/defects/cut_patches.h"

#include <vector>

#include "libreeb/base/memory_budget.h"

namespace reeb::tools {
namespace {

struct Place {
  std::vector<VertexId> seeds;
  std::vector<ooc::Ball> balls;
};

Place place_of(const DefectRow& row, const PatchScale& scale) {
  Place place{row.curve.path, {}};
  const double width = distance(row.curve.box[0], row.curve.box[1]);
  if (place.seeds.empty()) place.seeds = {row.lo.key.vertex, row.hi.key.vertex};
  if (!row.curve.path.empty()) {
    place.balls.push_back({row.curve.center, 1.5 * width + 4 * scale.edge});
  } else {
    for (const SettledNode* node : {&row.lo, &row.hi}) place.balls.push_back({node->position, 12 * scale.edge});
  }
  return place;
}

}  // namespace

void cut_patches(const ValuedMesh& mesh, const Defects& defects, std::span<const DefectRow* const> rows,
                 std::size_t most_vertices,
                 const std::function<void(std::size_t, const ooc::CollectedSurface::Patch&)>& visit) {
  std::vector<Place> places;
  std::vector<ooc::Ball> balls;
  for (const DefectRow* row : rows) {
    places.push_back(place_of(*row, defects.scale));
    balls.insert(balls.end(), places.back().balls.begin(), places.back().balls.end());
  }
  MemoryBudget budget(mesh.memory_bytes());
  ooc::CollectedSurface surface(balls, defects.functions.size(), budget);
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>> values, std::uint64_t, std::uint64_t) {
    surface.add(batch, values);
  });
  surface.finish();
  for (std::size_t i = 0; i < rows.size(); ++i) visit(i, surface.cut(places[i].seeds, places[i].balls, most_vertices));
}

}  // namespace reeb::tools
