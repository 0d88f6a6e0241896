// Port: how a mesh of any format reaches the engine, batch by batch (docs/SEMANTICS.md, Input).
//
// A reader delivers the events of one mesh in stream order, grouped into batches: structures of
// arrays of vertices, simplices and finalizations. Within a batch all vertices come first, then
// all simplices, then all finalizations; readers cut batches so that this is legal. With
// `ReadOptions::batch_events == 1` every batch holds exactly one event, in the order of the file.
//
// MEMORY: a reader holds one batch and windows of its input, never the file. memory_bytes() reports anything else that
//         it has to keep.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/port/indexed_mesh.h"

namespace reeb {

// Cleared and refilled by each read, so that its memory is reused.
struct MeshBatch {
  VertexId first_vertex;         // index of the first vertex of this batch
  std::size_t vertex_count = 0;  // vertices are numbered first_vertex, first_vertex + 1, ...
  // coordinates[k][i] is the k-th coordinate of the i-th vertex; MeshInfo::dimension columns.
  std::vector<std::vector<double>> coordinates;
  // properties[k][i] is the k-th requested property (ReadOptions) of the i-th vertex.
  std::vector<std::vector<double>> properties;

  // Column k, numbered as in IndexedMesh::gather: coordinates first, then properties.
  std::vector<double>& column(std::size_t k) {
    return k < coordinates.size() ? coordinates[k] : properties[k - coordinates.size()];
  }
  const std::vector<double>& column(std::size_t k) const {
    return k < coordinates.size() ? coordinates[k] : properties[k - coordinates.size()];
  }

  // Three corners each. Repeated corners are legal: (a, b, b) is an edge, (a, a, a) a vertex.
  // Polygons arrive as fans from their first corner.
  std::vector<VertexId> triangles;
  // Four corners each.
  std::vector<VertexId> tetrahedra;
  // No later event names these vertices.
  std::vector<VertexId> finalized;

  std::size_t triangle_count() const { return triangles.size() / 3; }
  std::size_t tetrahedron_count() const { return tetrahedra.size() / 4; }
  bool empty() const { return vertex_count == 0 && triangles.empty() && tetrahedra.empty() && finalized.empty(); }
  void clear();  // keeps the columns and their capacity
};

struct MeshInfo {
  std::string format;                          // "PLY binary little endian", "OBJ", "SMC version 3"
  unsigned dimension = 3;                      // coordinates per vertex
  std::vector<std::string> property_names;     // scalar vertex properties a function can use
  std::optional<std::uint64_t> vertex_count;   // if the header announces it, or it is known otherwise
  std::optional<std::uint64_t> simplex_count;  // faces or cells, before polygons become fans
  bool finalizes = false;                      // the stream contains finalization
  bool float32 = false;                        // every number is exactly a float32
  std::uint64_t file_bytes = 0;                // 0: unknown (a pipe)
};

struct ReadOptions {
  std::vector<std::string> properties;  // vertex properties to deliver, by name
  std::size_t batch_events = 65536;     // vertices or simplices per batch, roughly
  bool all_properties = false;          // deliver those of MeshInfo::property_names instead
};

// THREADS: one at a time; different readers share nothing.
// TIME:    that of reading and parsing the input once.
class MeshReader {
 public:
  MeshReader() = default;
  MeshReader(const MeshReader&) = delete;
  MeshReader& operator=(const MeshReader&) = delete;
  virtual ~MeshReader() = default;

  // Known as soon as the reader exists.
  virtual const MeshInfo& info() const = 0;

  // Replaces `batch` by the next events. False, and an empty batch, at the end of the mesh.
  // THROWS: Error{kBadInput} with file and position. All events delivered before that are valid.
  virtual bool read(MeshBatch& batch) = 0;

  // The same mesh from its beginning, with random access to its vertices, if the format allows that on the input
  // itself; else null. The two are read independently of each other.
  virtual std::unique_ptr<IndexedMesh> indexed() const { return nullptr; }

  // How much of the input was read so far, in bytes of the file as stored on disk.
  virtual std::uint64_t bytes_read() const = 0;

  // The memory that it holds so far and that grows with the mesh.
  virtual std::uint64_t memory_bytes() const { return 0; }
  // What a user can do if that is too much, other than allowing more; empty: nothing.
  virtual std::string memory_hint() const { return {}; }

  // Harmless oddities of the input, one line each ("3 unknown lines were skipped"). Complete at the end of the mesh.
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace reeb
