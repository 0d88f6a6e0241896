// A file of vertices and cells as a sequence of steps, before cells become simplices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/cells/cell_division.h"
#include "libreeb/base/ids.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// A cell: the number of its nodes that are corners, and of those that are not, which follow them.
struct CellHead {
  CellShape shape = CellShape::kPoint;
  std::uint64_t corners = 0, inner_nodes = 0;
};

class CellInput {
 public:
  enum class Step { kVertices, kCell, kWait, kEnd };

  CellInput() = default;
  CellInput(const CellInput&) = delete;
  CellInput& operator=(const CellInput&) = delete;
  virtual ~CellInput() = default;

  // Known as soon as the input exists.
  virtual const MeshInfo& info() const = 0;
  // Whether there may be cells with inner nodes.
  virtual bool has_inner_nodes() const = 0;

  // After kVertices, read_vertices() is called; after kCell, read_node() for each of its nodes. kWait: there is more,
  // but first the caller can look at memory_bytes().
  // REQUIRES: what the step before announced was read.
  virtual Step next(CellHead& cell) = 0;
  // Appends the next vertices, at least one and at most `limit`, to the columns, and returns their number.
  virtual std::size_t read_vertices(std::span<std::vector<double>* const> columns, std::size_t limit) = 0;
  // The index of a vertex that came before: all are numbered from 0 in their order.
  virtual VertexId read_node() = 0;

  // As MeshReader.
  virtual std::uint64_t bytes_read() const = 0;
  virtual std::uint64_t memory_bytes() const { return 0; }
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace reeb::io
