#include "libreeb/port/mesh_reader.h"

#include <algorithm>

namespace reeb {

bool MeshBatch::has_cells() const {
  return std::any_of(simplices.begin() + 3, simplices.end(), [](const auto& corners) { return !corners.empty(); });
}

void MeshBatch::add_counts(SimplexCounts& counts) const {
  for (std::size_t k = 0; k < counts.size(); ++k) counts[k] += simplices[k].size() / (k + 1);
}

bool MeshBatch::empty() const {
  return vertex_count == 0 && finalized.empty() &&
         std::all_of(simplices.begin(), simplices.end(), [](const auto& corners) { return corners.empty(); });
}

void MeshBatch::clear() {
  vertex_count = 0;
  for (auto& column : coordinates) column.clear();
  for (auto& column : properties) column.clear();
  for (auto& corners : simplices) corners.clear();
  finalized.clear();
}

}  // namespace reeb
