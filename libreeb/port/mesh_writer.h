// Port: where a mesh goes, batch by batch.
#pragma once

#include <string>
#include <vector>

#include "libreeb/port/mesh_reader.h"

namespace reeb {

// The file appears under its name when close() returns; without close() there is no file.
// MEMORY: a few MiB, whatever the mesh. In PLY and OFF all vertices come before the first face. So faces wait in a
//         nameless file in the output's folder until the last vertex was written.
class MeshWriter {
 public:
  MeshWriter() = default;
  MeshWriter(const MeshWriter&) = delete;
  MeshWriter& operator=(const MeshWriter&) = delete;
  virtual ~MeshWriter() = default;

  // REQUIRES: batches in stream order, with the columns that the options name.
  // THROWS: Error{kResource} if the output cannot be written;
  //         Error{kBadInput} if the format cannot hold the mesh.
  virtual void write(const MeshBatch& batch) = 0;
  virtual void close() = 0;
  // Content that the format could not hold, one line each. Complete after close().
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace reeb
