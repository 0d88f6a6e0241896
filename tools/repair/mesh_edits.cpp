#include "tools/repair/mesh_edits.h"

namespace reeb::tools {

void MeshEdits::add(const MeshEdits& other) {
  const std::uint64_t base = vertices.size();
  const auto moved = [&](VertexRef ref) {
    if (ref.is_new) ref.number += base;
    return ref;
  };
  removed.insert(removed.end(), other.removed.begin(), other.removed.end());
  dropped.insert(dropped.end(), other.dropped.begin(), other.dropped.end());
  for (NewVertex vertex : other.vertices) {
    for (VertexRef& parent : vertex.parents) parent = moved(parent);
    vertices.push_back(vertex);
  }
  for (std::array<VertexRef, 3> corners : other.triangles) {
    for (VertexRef& corner : corners) corner = moved(corner);
    triangles.push_back(corners);
  }
}

void MeshEdits::sort() {
  for (std::vector<std::uint64_t>* list : {&removed, &dropped}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
}

}  // namespace reeb::tools
