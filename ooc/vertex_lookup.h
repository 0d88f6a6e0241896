// The values of a chunk's vertices, looked up in a mesh.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "ooc/chunk_source.h"
#include "ooc/function_values.h"

namespace reeb::ooc {

class VertexLookup {
 public:
  explicit VertexLookup(FunctionValues& columns) : columns_(columns) {}

  // Sets positions and values of the item's vertices, whose ids become those of the input.
  // THROWS: what the mesh and the functions throw.
  void look_up(IndexedMesh& mesh, WorkItem& item) {
    const std::size_t n = item.chunk.vertex_count();
    gathered_.resize(n * columns_.columns().size());
    mesh.gather(item.chunk.ids, columns_.columns(), gathered_);
    data_.clear();
    for (std::size_t k = 0; k < columns_.columns().size(); ++k) data_.emplace_back(gathered_.data() + k * n, n);
    mesh.to_original(item.chunk.ids);
    columns_.evaluate(item.chunk.ids, data_, item.chunk.positions, item.values);
  }

 private:
  FunctionValues& columns_;
  std::vector<double> gathered_;
  std::vector<std::span<const double>> data_;
};

}  // namespace reeb::ooc
