// Port: a mesh whose vertices can be looked up and whose simplices can be read again and again.
//
// This is what the bounded-memory pipeline works on: pass 1 reads the simplices for finalization,
// pass 2 reads them again and looks up the vertices of each chunk. Formats with fixed vertex
// records implement it on the file itself; all others are first spooled into such a form.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/ids.h"

namespace reeb {

// THREADS: one at a time; different meshes share nothing.
class IndexedMesh {
 public:
  IndexedMesh() = default;
  IndexedMesh(const IndexedMesh&) = delete;
  IndexedMesh& operator=(const IndexedMesh&) = delete;
  virtual ~IndexedMesh() = default;

  virtual std::uint64_t vertex_count() const = 0;
  // Columns a vertex has: its coordinates, then the properties asked for when it was opened.
  virtual unsigned column_count() const = 0;

  // values[k * ids.size() + i] = column columns[k] of vertex ids[i]; -0.0 is delivered as 0.0.
  // Fast where ids are near each other; any order is legal.
  // REQUIRES: ids are below vertex_count(), columns below column_count().
  // THROWS: Error{kBadInput} with the place of a value that is not finite.
  virtual void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) = 0;

  // Replaces vertices by their indices in the input, for a mesh that was renumbered since.
  virtual void to_original([[maybe_unused]] std::span<VertexId> ids) {}

  // Starts the simplices again from the first.
  virtual void rewind() = 0;
  // Replaces `corners` by the next triangles, three corners each, as in MeshBatch::triangles; a
  // tetrahedron is delivered as its four faces. At most `limit` triangles. False at the end.
  // All corners are below vertex_count().
  virtual bool read(std::vector<VertexId>& corners, std::size_t limit) = 0;

  // Bytes of input consumed since rewind, and in all, for progress.
  virtual std::uint64_t bytes_read() const = 0;
  virtual std::uint64_t bytes_total() const = 0;

  // As MeshReader::warnings; final once read() has returned false.
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace reeb
