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

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/graph/settled_node.h"
#include "libreeb/port/grid_reader.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/simplex_counts.h"

namespace reeb {

// Cleared and refilled by each read, so that its memory is reused.
struct MeshBatch {
  // Index of the first vertex of this batch; in a grid of which some vertices are skipped, no vertex has the indices
  // between the last one of the batch before and this one.
  VertexId first_vertex;
  std::size_t vertex_count = 0;  // vertices are numbered first_vertex, first_vertex + 1, ...
  // coordinates[k][i] is the k-th coordinate of the i-th vertex; MeshInfo::dimension columns.
  std::vector<std::vector<double>> coordinates;
  // properties[k][i] is the k-th requested property (ReadOptions) of the i-th vertex. One that is delivered only since
  // all are (all_properties) need not be finite.
  std::vector<std::vector<double>> properties;

  // Of vertex i of the batch: its first three coordinates, 0 where there are fewer.
  Point position(std::size_t i) const {
    Point point{};
    for (std::size_t k = 0; k < std::min<std::size_t>(3, coordinates.size()); ++k) point[k] = coordinates[k][i];
    return point;
  }

  // Column k, numbered as in IndexedMesh::gather: coordinates first, then properties.
  std::vector<double>& column(std::size_t k) {
    return k < coordinates.size() ? coordinates[k] : properties[k - coordinates.size()];
  }
  const std::vector<double>& column(std::size_t k) const {
    return k < coordinates.size() ? coordinates[k] : properties[k - coordinates.size()];
  }

  // simplices[k]: those of dimension k, k + 1 corners each. A simplex counts as the set of its corners, so repeated
  // corners are legal. Polygons arrive as fans of triangles from their first corner.
  std::array<std::vector<VertexId>, kMaxSimplexDimension + 1> simplices;
  // No later event names these vertices.
  std::vector<VertexId> finalized;

  std::vector<VertexId>& points() { return simplices[0]; }
  std::vector<VertexId>& edges() { return simplices[1]; }
  std::vector<VertexId>& triangles() { return simplices[2]; }
  std::vector<VertexId>& tetrahedra() { return simplices[3]; }
  const std::vector<VertexId>& points() const { return simplices[0]; }
  const std::vector<VertexId>& edges() const { return simplices[1]; }
  const std::vector<VertexId>& triangles() const { return simplices[2]; }
  const std::vector<VertexId>& tetrahedra() const { return simplices[3]; }

  std::size_t triangle_count() const { return triangles().size() / 3; }
  // The number of simplices of dimension kMost or less.
  template <std::size_t kMost = kMaxSimplexDimension>
  std::size_t simplex_count() const {
    return [this]<std::size_t... kDimensions>(std::index_sequence<kDimensions...>) {
      return (... + (simplices[kDimensions].size() / (kDimensions + 1)));
    }
    (std::make_index_sequence<kMost + 1>());
  }
  // Whether there is a simplex of more than three corners.
  bool has_cells() const;
  // Calls visit(corners) for every simplex, by dimension.
  template <class Visit>
  void for_each_simplex(const Visit& visit) const {
    for (std::size_t k = 0; k < simplices.size(); ++k)
      for (std::size_t i = 0; i < simplices[k].size(); i += k + 1) visit(std::span(simplices[k]).subspan(i, k + 1));
  }
  void add_counts(SimplexCounts& counts) const;
  bool empty() const;
  void clear();  // keeps the columns and their capacity
};

struct MeshInfo {
  std::string format;                         // "PLY binary little endian", "OBJ", "SMC version 3"
  unsigned dimension = 3;                     // coordinates per vertex
  std::vector<std::string> property_names;    // scalar vertex properties a function can use
  std::optional<std::uint64_t> vertex_count;  // if the header announces it, or it is known otherwise
  std::optional<std::uint64_t> number_count;  // of all vertices, if some are left out but the others keep their numbers
  std::optional<std::uint64_t> simplex_count;  // faces or cells, before polygons become fans
  bool finalizes = false;                      // the stream contains finalization
  bool float32 = false;                        // every number is exactly a float32
  std::uint64_t file_bytes = 0;                // 0: unknown (a pipe)
  std::optional<GridInfo> grid;                // set if the mesh is an image
};

struct ReadOptions {
  std::vector<std::string> properties;  // vertex properties to deliver, by name
  std::size_t batch_events = 65536;     // vertices or simplices per batch, roughly
  bool all_properties = false;          // deliver those of MeshInfo::property_names instead
  // Where a pipe is copied to, if its format cannot be read in one go, and a packed file of many arrays; empty: where
  // temporary files are by default.
  std::string temp_folder{};
  bool value_of_image = false;  // if the mesh is an image, and no property is named: deliver "value"
  bool signed_zeros = false;    // PLY, OBJ, OFF, streams: deliver -0.0 where the file has it; else it becomes 0.0
  bool names_losses = false;    // OBJ: warnings() name what the file has beside vertices and simplices
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

  // Replaces `batch` by the next events. False, and an empty batch, at the end of the mesh. A reader that holds many
  // events back delivers fewer of them, or none, so that the caller can look at memory_bytes().
  // THROWS: Error{kBadInput} with file and position. All events delivered before that are valid.
  virtual bool read(MeshBatch& batch) = 0;

  // The same mesh from its beginning, with random access to its vertices, if the format allows that on the input
  // itself; else null. The two are read independently of each other.
  virtual std::unique_ptr<IndexedMesh> indexed() const { return nullptr; }

  // Leaves simplices and finalizations out of all batches, if the mesh is a grid: then they follow from its size, and
  // from the vertices that are skipped. Returns whether it does. REQUIRES: nothing was read yet.
  virtual bool leave_out_simplices() { return false; }

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
