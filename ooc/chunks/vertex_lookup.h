// The values of a chunk's vertices, looked up in a mesh.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "libreeb/port/indexed_mesh.h"
#include "libreeb/sweep/chunk.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/function_values.h"

namespace reeb::ooc {

class VertexLookup {
 public:
  explicit VertexLookup(FunctionValues& functions) : functions_(functions) {}

  // Sets the positions and values of the item's vertices. Their ids become those of the input.
  // THROWS: what the mesh and the functions throw.
  void look_up(IndexedMesh& mesh, WorkItem& item) {
    constexpr std::size_t kVerticesAtOnce = 1024;  // so that columns of them stay in the first-level cache
    const std::size_t n = item.chunk.vertex_count();
    clear_with_room(item.chunk.positions, n);
    item.values.resize(functions_.function_count());
    for (auto& values : item.values) clear_with_room(values, n);
    for (std::size_t first = 0; first < n; first += kVerticesAtOnce)
      look_up(mesh, std::span(item.chunk.ids).subspan(first, std::min(kVerticesAtOnce, n - first)), item);
  }

 private:
  void look_up(IndexedMesh& mesh, std::span<VertexId> ids, WorkItem& item) {
    const std::size_t n = ids.size();
    gathered_.resize(n * functions_.columns().size());
    mesh.gather(ids, functions_.columns(), gathered_);
    data_.clear();
    for (std::size_t k = 0; k < functions_.columns().size(); ++k) data_.emplace_back(gathered_.data() + k * n, n);
    mesh.to_original(ids);
    functions_.evaluate(ids, data_, item.chunk.positions, item.values);
  }

  FunctionValues& functions_;
  std::vector<double> gathered_;
  std::vector<std::span<const double>> data_;
};

}  // namespace reeb::ooc
