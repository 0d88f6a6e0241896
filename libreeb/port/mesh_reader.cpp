#include "libreeb/port/mesh_reader.h"

namespace reeb {

void MeshBatch::clear() {
  vertex_count = 0;
  for (auto& column : coordinates) column.clear();
  for (auto& column : properties) column.clear();
  triangles.clear();
  tetrahedra.clear();
  finalized.clear();
}

}  // namespace reeb
