// Values for which all of a mesh must be known: geodesic distances and eigenvectors.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/file/input_file.h"
#include "io/functions/function_spec.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// Of one function; empty if it needs nothing.
struct MeshField {
  std::shared_ptr<const InputFile> values;  // a float64 for each vertex, in a file without a name
  std::vector<std::string> notes;
};

// Opens the mesh at its beginning.
using OpenMesh = std::function<std::unique_ptr<MeshReader>()>;

// One field a function. Reads the mesh once for all functions that need it, or not at all; `open_mesh` is empty if the
// mesh can be read only once. All of it is held meanwhile (io/fields says how much, and how exact the values are); the
// values then wait in files in `temp_folder`, so that a run does not hold them.
// THROWS: Error{kBadInput} of the reader, and for a vertex that the mesh does not have, that a geodesic cannot reach,
//         or an eigenvector that does not exist; Error{kResource} with what `memory_bytes` lacks, before the work.
std::vector<MeshField> read_fields(std::span<const FunctionSpec> specs, const OpenMesh& open_mesh,
                                   const std::string& mesh_name, const std::string& temp_folder,
                                   std::uint64_t memory_bytes);

}  // namespace reeb::io
