#include "tools/report/closeups.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/defects/cut_patches.h"
#include "tools/report/page_text.h"

namespace reeb::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostVertices = 2000;  // some 50 KB of the page

Json curve_json(const SurfacePatch& patch, const std::vector<VertexId>& path) {
  std::vector<std::uint32_t> local;
  local.reserve(path.size());
  for (const VertexId vertex : path) local.push_back(patch.find(vertex));
  if (std::ranges::find(local, SurfacePatch::kNone) != local.end()) local.clear();
  return local;
}

Json closeup_json(const SurfacePatch& patch, const std::vector<double>& values, const DefectRow& row) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Point min{kInfinity, kInfinity, kInfinity}, max{-kInfinity, -kInfinity, -kInfinity};
  for (std::uint32_t v = 0; v < patch.vertex_count(); ++v)
    for (std::size_t k = 0; k < 3; ++k) {
      min[k] = std::min(min[k], patch.position(v)[k]);
      max[k] = std::max(max[k], patch.position(v)[k]);
    }
  const double size = patch.vertex_count() == 0 ? 0 : std::max({max[0] - min[0], max[1] - min[1], max[2] - min[2]});
  std::vector<std::uint16_t> places, triangles;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  for (std::uint32_t v = 0; v < patch.vertex_count(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) places.push_back(in_65535ths(patch.position(v)[k], min[k], size / 2));
    places.push_back(in_65535ths(values[v], *lowest, *highest / 2 - *lowest / 2));
  }
  for (std::uint32_t t = 0; t < patch.triangle_count(); ++t)
    for (const std::uint32_t corner : patch.oriented(t)) triangles.push_back(static_cast<std::uint16_t>(corner));
  return {{"size", size},
          {"min", patch.vertex_count() == 0 ? Point{} : min},
          {"length", row.curve.found() ? Json(row.curve.length) : Json()},
          {"center", row.curve.place.center},
          {"places", base64(places)},
          {"triangles", base64(triangles)},
          {"curve", curve_json(patch, row.curve.path)},
          {"other", curve_json(patch, row.other_path)}};
}

}  // namespace

Json closeups_json(const ValuedMesh& mesh, const Defects& defects) {
  std::vector<const DefectRow*> rows;
  for (const DefectRow& row : defects.table.rows)
    if (rows.size() < kMostCloseups) rows.push_back(&row);
  Json list = Json::array();
  if (rows.empty()) return list;
  cut_patches(mesh, defects, rows, kMostVertices, [&](std::size_t i, const ooc::CollectedSurface::Patch& patch) {
    Json item = closeup_json(patch.surface, patch.values[rows[i]->function], *rows[i]);
    item["kind"] = name_of(rows[i]->kind);
    item["limited"] = patch.limited;
    list.push_back(std::move(item));
  });
  return list;
}

}  // namespace reeb::tools
