#include "tools/defects/cut_patches.h"

#include <vector>

#include "libreeb/base/memory_budget.h"
#include "ooc/patches/divided_surface.h"

namespace reeb::tools {
namespace {

constexpr double kMostTogether = 200'000;  // vertices of patches in memory, roughly
constexpr double kMostRadius = 1e154;      // its square is a double, so that a ball has its center

struct Place {
  std::vector<VertexId> seeds;
  std::vector<ooc::Ball> balls;
};

Place place_of(const DefectRow& row, const PatchScale& scale) {
  Place place{row.curve.path, {}};
  const double width = distance(row.curve.place.box[0], row.curve.place.box[1]);
  if (place.seeds.empty()) place.seeds = {row.lo.key.vertex, row.hi.key.vertex};
  if (row.curve.found()) place.balls.push_back({row.curve.place.center, 1.5 * width + 4 * scale.edge});
  if (row.curve.path.empty()) {
    for (const SettledNode* node : {&row.lo, &row.hi}) place.balls.push_back({node->position, 12 * scale.edge});
  }
  for (ooc::Ball& ball : place.balls) ball.radius = ball.radius < kMostRadius ? ball.radius : kMostRadius;
  return place;
}

}  // namespace

void cut_patches(const ValuedMesh& mesh, const Defects& defects, std::span<const DefectRow* const> rows,
                 std::size_t most_vertices,
                 const std::function<void(std::size_t, const ooc::CollectedSurface::Patch&)>& visit) {
  std::vector<Place> places;
  std::vector<ooc::GroupedBall> balls;
  std::vector<std::uint32_t> group_of;
  double sum = 0;
  std::uint32_t group = 0;
  for (const DefectRow* row : rows) {
    places.push_back(place_of(*row, defects.scale));
    if (sum >= kMostTogether) {
      ++group;
      sum = 0;
    }
    group_of.push_back(group);
    for (const ooc::Ball& ball : places.back().balls) {
      balls.push_back({ball, group});
      sum += defects.scale.vertices(ball.radius);
    }
  }
  MemoryBudget budget(mesh.memory_bytes());
  const io::TempDir temp(mesh.temp_folder());
  ooc::DividedSurface surfaces(balls, group + 1, defects.functions.size(), temp, budget);
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>> values, std::uint64_t, std::uint64_t) {
    surfaces.add(batch, values);
  });
  surfaces.finish();
  for (std::size_t i = 0; i < rows.size();) {
    const std::uint32_t now = group_of[i];
    const ooc::CollectedSurface surface = surfaces.surface(now);
    for (; i < rows.size() && group_of[i] == now; ++i)
      visit(i, surface.cut(places[i].seeds, places[i].balls, most_vertices));
  }
}

}  // namespace reeb::tools
