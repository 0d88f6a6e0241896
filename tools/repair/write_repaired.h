// One reading of a mesh that writes it with edits; and one that takes them back.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "tools/defects/valued_mesh.h"
#include "tools/repair/mesh_edits.h"
#include "tools/repair/undo_file.h"

namespace reeb::tools {

struct WriteOptions {
  std::string output;
  io::Existing existing = io::Existing::kRefuse;
  bool keep_undo = false;
  std::function<void(std::uint64_t done, std::uint64_t total, std::uint64_t triangles)> progress{};
};

struct Written {
  std::uint64_t vertices = 0, triangles = 0;
  UndoRecord undo;                    // if it is wanted
  std::vector<std::string> warnings;  // one line each
};

// Vertices and triangles that stay keep their order and their values; new ones are the last. `before_commit` is called
// when all was written, just before the output appears.
// THROWS: as the readers and writers; Error{kChanged} if the mesh does not have these numbers of vertices and
//         triangles.
Written write_repaired(const MeshSource& source, const MeshEdits& edits, std::uint64_t mesh_vertices,
                       std::uint64_t mesh_triangles, const WriteOptions& options,
                       const std::function<void(const Written&)>& before_commit);

// The mesh before the repair: vertices and triangles in their old order.
// THROWS: also Error{kBadInput} if the mesh is not the repaired one.
Written write_undone(const MeshSource& source, const UndoRecord& undo, const WriteOptions& options);

}  // namespace reeb::tools
