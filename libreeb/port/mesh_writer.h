// Port: where a mesh goes, batch by batch.
#pragma once

#include <string>
#include <vector>

#include "libreeb/port/mesh_reader.h"

namespace reeb {

// The file appears under its name when close() returns; without close() there is none.
// MEMORY: a few MiB, whatever the mesh. PLY and OFF want all vertices before the first face; while
//         more vertices may come, faces wait in a nameless file in the output's folder.
class MeshWriter {
 public:
  MeshWriter() = default;
  MeshWriter(const MeshWriter&) = delete;
  MeshWriter& operator=(const MeshWriter&) = delete;
  virtual ~MeshWriter() = default;

  // REQUIRES: batches in stream order, with the columns that the options say.
  // THROWS: Error{kResource} if the output cannot be written;
  //         Error{kBadInput} if the format cannot hold the mesh.
  virtual void write(const MeshBatch& batch) = 0;
  virtual void close() = 0;
  // What the format could not hold, one line each. Final after close().
  virtual std::vector<std::string> warnings() const { return {}; }
};

// Pipes all that `reader` delivers into `writer` and closes it.
void copy_mesh(MeshReader& reader, MeshWriter& writer);

}  // namespace reeb
