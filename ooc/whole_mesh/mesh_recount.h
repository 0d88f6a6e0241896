// What a mesh itself says of its Reeb graph, counted without computing one.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "libreeb/port/mesh_reader.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

struct MeshRecount {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;   // as the mesh lists them; a tetrahedron is four
  std::uint64_t components = 0;  // of the mesh, by union-find over its vertices
  std::int64_t euler = 0;        // vertices - edges + triangles, of distinct ones with distinct corners

  // Where the mesh is a surface (with isolated points): at most two triangles at each edge, one fan
  // at each vertex. Then the loops of any Reeb graph of it are at most this many: its genus if it is
  // closed, else its first Betti number. They can be fewer: a vertex at which a contour splits and
  // meets itself again hides a loop.
  std::optional<std::uint64_t> most_loops;
  bool closed = false;
};

using BatchObserver = std::function<void(const MeshBatch&)>;

// Reads the mesh to its end, once. `observe` sees each batch, too.
//
// MEMORY: tables of 8 bytes a vertex and a corner, and sorts of 24 bytes a triangle and an edge
//         of each, all on disk beyond the space's budget.
// THROWS: Error{kBadInput} of the reader; what `observe` throws.
MeshRecount recount_mesh(MeshReader& reader, Workspace& space, const BatchObserver& observe = {});

}  // namespace reeb::ooc
