// A mesh that is written like the one that was read: the same columns with the same types.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/content_source.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/mesh_writer.h"
#include "tools/defects/valued_mesh.h"

namespace reeb::tools {

// With all properties if `output` can hold them.
std::unique_ptr<MeshReader> open_for_copy(const io::Input& input, const MeshSource& source, const std::string& output);

// Whether all coordinates are float32 numbers, so that new ones must be.
bool has_float32_positions(const io::Input& input, const MeshInfo& info);

// What such a copy cannot keep, one line each.
std::vector<std::string> lost_properties(const io::Input& input, const MeshInfo& info, const std::string& output);

// `vertices`: how many will be written.
std::unique_ptr<MeshWriter> create_like(const io::Input& input, const MeshReader& reader, const std::string& output,
                                        std::uint64_t vertices, const std::string& temp_folder, io::Existing existing);

// A digest of the coordinates and triangles of a mesh, which does not depend on how they are divided into batches. A
// coordinate that the mesh does not have counts as 0, since formats such as PLY write it.
class MeshDigest {
 public:
  void add(const MeshBatch& batch);
  std::array<std::uint64_t, 4> value() const;

 private:
  std::array<io::RunningDigest, 4> parts_;  // three coordinates, triangles
};

}  // namespace reeb::tools
