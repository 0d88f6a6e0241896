// Checks the nodes of a graph against the vertices of its mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/functions/function_source.h"
#include "io/functions/mesh_field.h"
#include "libreeb/base/value_range.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/mesh_reader.h"
#include "tools/checks/node_places.h"

namespace reeb::tools {

// Compares each node with its vertex while the mesh is read: the position (if the graph has positions) and the value of
// the function. Values are not compared if the file that they came from is gone, or if they depend on a vertex of a
// mesh that can be read only once. THROWS: Error{kBadInput} at the first node that differs from its vertex.
class NodeCheck {
 public:
  // `mesh` and `graph` must outlive this; `file` is for messages.
  // THROWS: Error{kBadInput} if `function` is no function.
  NodeCheck(const std::string& file, const std::string& mesh, const std::string& function, const ReebGraph& graph);

  // Why values are not compared; empty if they are. Known after start().
  const std::string& unchecked() const { return unchecked_; }
  // The file of values, if it is gone; else empty.
  std::string missing_file() const;
  // The properties that the reader must deliver.
  const std::vector<std::string>& properties() const { return properties_; }
  // `open_again` opens the mesh another time, for functions that depend on a vertex; empty: that is not possible.
  // Folder and memory are for functions that need all of the mesh (io/functions/mesh_field.h).
  void start(const MeshInfo& info, const io::OpenMesh& open_again, const std::string& temp_folder,
             std::uint64_t memory_bytes);
  void add(const MeshBatch& batch);
  // The range of the function over the mesh; null if it could not be evaluated.
  // THROWS: Error{kBadInput} for the first node that is not in the mesh as it is in the graph, after the whole mesh is
  // read: it may be another one, which its counts tell better; Error{kChanged} if the file of values changed meanwhile.
  std::optional<ValueRange> finish();

 private:
  const ReebGraph& graph_;
  const std::string& mesh_;
  NodePlaces places_;
  std::uint64_t read_ = 0;  // vertices
  io::FunctionSpec spec_;
  std::vector<std::string> properties_;
  std::optional<io::FunctionSource> source_;
  std::vector<double> values_;
  ValueRange range_;
  std::string unchecked_;
};

}  // namespace reeb::tools
