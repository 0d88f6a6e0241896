#include "tools/checks/node_places.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "libreeb/format/mesh_match.h"

namespace reeb::tools {

NodePlaces::NodePlaces(const std::string& mesh, const ReebGraph& graph)
    : mesh_(mesh), graph_(graph), by_vertex_(graph.node_count()) {
  std::iota(by_vertex_.begin(), by_vertex_.end(), std::size_t{0});
  std::ranges::sort(by_vertex_, {}, [&](std::size_t node) { return graph.nodes[node].vertex; });
}

void NodePlaces::compare(std::size_t node, const MeshBatch& batch, std::size_t i) {
  for (std::size_t k = 0; k < 3 && !graph_.positions.empty(); ++k)
    if (graph_.positions[node][k] != (k < batch.coordinates.size() ? batch.coordinates[k][i] : 0.0))
      fail(node, "has another position in the mesh");
}

void NodePlaces::fail(std::size_t node, const char* why) {
  if (!failure_) failure_ = wrong_mesh(mesh_, graph_.nodes[node].vertex, why);
}

void NodePlaces::finish() {
  if (next_ != by_vertex_.size()) fail(by_vertex_[next_], "is not in the mesh");
  if (failure_) throw *failure_;
}

void NodePlaces::finish(const std::string& file, const FileHeader& header) {
  require_same_mesh(file, {header.mesh_vertices, header.mesh_triangles}, {vertices_, triangles_});
  finish();
}

Error wrong_mesh(const std::string& mesh, VertexId vertex, const char* why) {
  return Error(ErrorKind::kBadInput, fmt::format("the node of vertex {} {}", vertex.value(), why),
               "name the mesh that the file was computed from; an image needs the --spacing of that run")
      .at(mesh);
}

}  // namespace reeb::tools
