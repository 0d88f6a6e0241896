// Facts about a Reeb graph that can be counted on the mesh without computing the graph.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "libreeb/port/mesh_reader.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

struct MeshRecount {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;   // as the mesh lists them, without edges and the faces of cells
  std::uint64_t components = 0;  // of the mesh, by union-find over its vertices
  std::int64_t euler = 0;        // vertices - edges + triangles, of distinct ones with distinct corners

  // Set if the mesh is a surface (with isolated points): at most two triangles at each edge, one fan at each vertex.
  // Then any Reeb graph of it has at most this many loops: half its first Betti number if it is closed, which is the
  // genus of one that can be oriented; else its first Betti number. It can have fewer: a vertex at which a contour
  // splits and meets itself again hides a loop.
  std::optional<std::uint64_t> most_loops;
  bool closed = false;
};

using BatchObserver = std::function<void(const MeshBatch&)>;

// Reads the mesh to its end, once. `observe` also sees each batch.
//
// MEMORY: tables of 8 bytes per vertex and per corner, and sorts of 24 bytes per triangle and per edge of each; beyond
//         the space's budget they are on disk.
// THROWS: Error{kBadInput} of the reader; what `observe` throws.
MeshRecount recount_mesh(MeshReader& reader, Workspace& space, const BatchObserver& observe = {});

}  // namespace reeb::ooc
