// Whether the nodes of a graph are where the vertices of a mesh are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/ids.h"
#include "libreeb/format/file_header.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::tools {

// That the vertex of a node is another one in this mesh: `why` is "has another value in the mesh" or the like.
Error wrong_mesh(const std::string& mesh, VertexId vertex, const char* why);

// Compares the position of each node (if the graph has positions) with that of its vertex while the mesh is read.
// MEMORY: 8 bytes a node.
class NodePlaces {
 public:
  // Both must outlive this.
  NodePlaces(const std::string& mesh, const ReebGraph& graph);

  // The next batch. Calls visit(node, i) for each node that is vertex i of the batch.
  template <class Visit>
  void add(const MeshBatch& batch, const Visit& visit) {
    const std::uint64_t first = batch.first_vertex.value(), end = first + batch.vertex_count;
    for (; next_ < by_vertex_.size() && graph_.nodes[by_vertex_[next_]].vertex.value() < end; ++next_) {
      const std::size_t node = by_vertex_[next_];
      const auto i = static_cast<std::size_t>(graph_.nodes[node].vertex.value() - first);
      visit(node, i);
      compare(node, batch, i);
    }
    vertices_ += batch.vertex_count;
    triangles_ += batch.triangle_count();
  }
  void add(const MeshBatch& batch) {
    add(batch, [](std::size_t, std::size_t) {});
  }
  // Says that a node is another one in the mesh.
  void fail(std::size_t node, const char* why);

  // After the last batch. THROWS: Error{kBadInput} for the first node that is not in the mesh as it is in the graph.
  void finish();
  // The same, and the counts, which tell more of another mesh, are compared first. `file` is that of the graph.
  void finish(const std::string& file, const FileHeader& header);

 private:
  void compare(std::size_t node, const MeshBatch& batch, std::size_t i);

  const std::string& mesh_;
  const ReebGraph& graph_;
  std::vector<std::size_t> by_vertex_;
  std::size_t next_ = 0;
  std::uint64_t vertices_ = 0, triangles_ = 0;
  std::optional<Error> failure_;
};

}  // namespace reeb::tools
