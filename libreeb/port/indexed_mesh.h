// Port: a mesh whose vertices can be looked up and whose simplices can be read repeatedly.
//
// A pass over such a mesh reads the simplices and looks up the vertices of each chunk. Unless the run can guess when a
// vertex is complete, a pass before reads the simplices for their last uses. Formats with fixed vertex records
// implement it on the file itself; other formats are spooled into such a form.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/port/simplex_counts.h"

namespace reeb {

// A place between two triangles, as the mesh itself understands it. It stays valid as long as the mesh.
struct MeshPlace {
  std::uint64_t first = 0, second = 0;
  friend bool operator==(const MeshPlace&, const MeshPlace&) = default;
};

// THREADS: one at a time, but gather() may be called while another thread reads triangles. Different meshes share
// nothing.
class IndexedMesh {
 public:
  IndexedMesh() = default;
  IndexedMesh(const IndexedMesh&) = delete;
  IndexedMesh& operator=(const IndexedMesh&) = delete;
  virtual ~IndexedMesh() = default;

  virtual std::uint64_t vertex_count() const = 0;
  // The number of columns of a vertex: its coordinates, then the properties requested when the mesh was opened.
  virtual unsigned column_count() const = 0;

  // values[k * ids.size() + i] = column columns[k] of vertex ids[i]; -0.0 is delivered as 0.0.
  // Fast where ids are near each other; any order is legal.
  // REQUIRES: ids are below vertex_count(), columns below column_count().
  // THROWS: Error{kBadInput} with the location of a value that is not finite, unless it is of a property that is
  // delivered only since all are (ReadOptions::all_properties).
  virtual void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) = 0;

  // Replaces vertices by their indices in the input, if this mesh was renumbered.
  virtual void to_original([[maybe_unused]] std::span<VertexId> ids) {}
  // More than any of these indices.
  virtual std::uint64_t number_count() const { return vertex_count(); }
  // The inverse, for a mesh with vertices in the order of the input. What the mesh does not have becomes none().
  virtual void from_original(std::span<VertexId> ids) const {
    for (VertexId& id : ids)
      if (id.value() >= vertex_count()) id = VertexId::none();
  }

  // read() starts again at the first simplex.
  virtual void rewind() = 0;
  // Replaces `corners` by the next triangles that decide the Reeb graph, three corners each: an edge is (a, b, b) in
  // this form, a point is (a, a, a), and of a simplex with more than three corners come the triangles through its
  // vertex of lowest index (libreeb/port/deciding_triangles.h). Their order does not depend on `limit`, which is the
  // most triangles at a time. False at the end. All corners are below vertex_count().
  virtual bool read(std::vector<VertexId>& corners, std::size_t limit) = 0;
  // What the mesh lists. Final once everything was read from the first simplex to the last.
  virtual SimplexCounts simplex_counts() const = 0;

  // Where read() goes on. Nothing if the mesh cannot return there: not at all, or not at a small cost.
  virtual std::optional<MeshPlace> place() const { return std::nullopt; }
  // read() goes on there. REQUIRES: place() of this mesh returned it.
  virtual void seek([[maybe_unused]] const MeshPlace& place) {}

  // The number of triangles, judged by size: the bytes of all records, divided by those of a triangle. It is a guess
  // until read() has gone through all records after seek_triangle(0).
  virtual std::optional<std::uint64_t> triangles_by_size() const { return std::nullopt; }
  // read() goes on at the triangle with this number, and throws Error{kChanged} at a record that is no triangle.
  // REQUIRES: it is at most triangles_by_size().
  virtual void seek_triangle([[maybe_unused]] std::uint64_t number) {}

  // Bytes of input read since rewind(), and in total, for progress.
  virtual std::uint64_t bytes_read() const = 0;
  virtual std::uint64_t bytes_total() const = 0;

  // As MeshReader::warnings; final once read() has returned false.
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace reeb
