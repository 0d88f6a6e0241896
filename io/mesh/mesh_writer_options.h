// What a mesh writer knows before the first batch.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/mesh/scalar_bytes.h"

namespace reeb::io {

struct MeshWriterOptions {
  unsigned dimension = 3;                         // coordinates per vertex
  std::vector<std::string> property_names{};      // columns of MeshBatch::properties; PLY and volume meshes keep them
  std::vector<std::string> integer_properties{};  // the last ones of these that are whole numbers: PLY, VTK
  bool float64 = false;                           // numbers of PLY and lists of events: double instead of float
  std::vector<ScalarType> column_types{};         // PLY: of the coordinates, then of the properties; empty: as above
  std::optional<std::uint64_t> vertex_count{};    // if known (more is an error); saves the temporary copy of the faces
  std::optional<std::uint64_t> simplex_count{};   // if known; for headers
  bool signed_zeros = false;                      // OBJ and OFF: write -0 where it is; PLY always does
  Existing existing = Existing::kRefuse;
  std::string temp_folder{};  // of that copy; empty: TempDir::default_folder of the output
};

}  // namespace reeb::io
