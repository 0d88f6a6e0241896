// Port: the function whose Reeb graph is computed, vertex by vertex.
#pragma once

#include <span>
#include <string>

#include "libreeb/base/ids.h"
#include "libreeb/port/indexed_mesh.h"

namespace reeb {

// THREADS: a run calls it from one thread at a time, not always the same.
// TIME:    evaluate() sees each vertex once, and where vertices are looked up, once for each chunk that has it.
class VertexFunction {
 public:
  VertexFunction() = default;
  VertexFunction(const VertexFunction&) = delete;
  VertexFunction& operator=(const VertexFunction&) = delete;
  virtual ~VertexFunction() = default;

  // As the user names it: "z", "random:1".
  virtual std::string name() const = 0;

  // The file other than the mesh from which it reads its values; empty: none.
  virtual std::string source_file() const { return {}; }

  // The columns of the mesh that evaluate() needs, numbered as in IndexedMesh::gather: coordinates first, then the
  // requested properties.
  virtual std::span<const unsigned> columns() const = 0;

  // Whether the function depends on single vertices, so that look_up() must come before the first evaluate().
  virtual bool needs_lookup() const { return false; }
  // THROWS: Error{kBadInput} if the mesh has no such vertex.
  virtual void look_up(IndexedMesh& /*mesh*/) {}

  // Call this when the number of vertices is known: before the first evaluate() if vertices are looked up, after the
  // last one if they come in order.
  // THROWS: Error{kBadInput} if there are values for more or fewer vertices.
  virtual void check_count(std::uint64_t /*vertices*/) {}
  // Call this after the last evaluate().
  // THROWS: Error{kChanged} if the file that it reads its values from changed meanwhile.
  virtual void check_unchanged() const {}
  // The memory that looking up the values of this number of vertices holds.
  virtual std::uint64_t lookup_bytes(std::uint64_t /*vertices*/) const { return 0; }

  // values[i] = f(ids[i]); columns[k][i] is column columns()[k] of that vertex. No -0.0 comes out.
  // THROWS: Error{kBadInput} that names the vertex if its value is not finite.
  virtual void evaluate(std::span<const VertexId> ids, std::span<const std::span<const double>> columns,
                        std::span<double> values) = 0;
};

}  // namespace reeb
