// Writes meshes: what any reader delivers goes into any format.
//
// Formats: binary little-endian PLY, OBJ, OFF (nOFF where a vertex has other than 3 coordinates),
// and the streaming meshes SMA, SMB, SMC (version 3), SVA and SVB, as well as lists of events.
// Every simplex is written as triangles: a tetrahedron as its four faces (but in volume meshes, SVA
// and SVB), an edge as a triangle with a repeated corner, so that nothing is lost that matters to a
// Reeb graph. Only streaming meshes hold finalizations.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

struct MeshWriterOptions {
  unsigned dimension = 3;  // coordinates a vertex
  std::vector<std::string>
      property_names{};  // columns of MeshBatch::properties; PLY and volume meshes keep them
  bool float64 = false;  // PLY numbers: double instead of float
  std::optional<std::uint64_t> vertex_count{};  // a promise; saves the temporary copy of the faces
  std::optional<std::uint64_t> simplex_count{};  // a promise too, for headers
  Existing existing = Existing::kRefuse;
};

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

// The suffix of a file's name in lower case: ".ply".
std::string name_suffix(const std::string& path);

// The format is told by the suffix of `path`: .ply .obj .off .sma .smb .smc .sva .svb .events.txt.
// THROWS: Error{kUsage} for another suffix; else as AtomicFile.
std::unique_ptr<MeshWriter> create_mesh(const std::string& path,
                                        const MeshWriterOptions& options = {});

// Pipes all that `reader` delivers into `writer` and closes it.
void copy_mesh(MeshReader& reader, MeshWriter& writer);

}  // namespace reeb::io
