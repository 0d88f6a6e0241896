// What a mesh itself says of its Reeb graph, counted without computing one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "libreeb/graph/reeb_graph.h"
#include "tools/workspace.h"

namespace reeb::tools {

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

  // Null if the function could not be evaluated anew.
  struct Range {
    double min = 0, max = 0;
  };
  std::optional<Range> range;
};

// Reads the mesh once. Each node of the graph is compared with its vertex: position (where the graph
// has positions) and value of the function, if that has a name that can be evaluated here.
//
// MEMORY: tables of 8 bytes a vertex and a corner, and sorts of 24 bytes a triangle and an edge
//         of each, all on disk beyond the space's budget.
// THROWS: Error{kBadInput} of the reader, or at the first node that is not its vertex.
MeshRecount recount_mesh(const std::string& mesh, const std::string& function, const ReebGraph& graph, Workspace& space);

}  // namespace reeb::tools
