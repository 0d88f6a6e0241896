// Arrays of a caller as a mesh: nothing is copied, whatever their types and layouts are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "libreeb/port/mesh_reader.h"
#include "tools/python/strided_array.h"

namespace reeb::python {

// A row is a vertex with its coordinates, or a simplex with its corners. Messages name a place in an array by its name
// and indices: "faces[3, 1]".
struct ArrayMesh {
  struct Property {
    std::string name;
    StridedArray values;  // one for each vertex
  };
  struct Simplices {
    std::string name;
    StridedArray corners;  // integers; 1 to 9 columns
  };

  StridedArray vertices;  // 1 to 9 columns
  std::vector<Property> properties;
  std::vector<Simplices> simplices;
};

// `mesh` must not change as long as the reader, or what its indexed() returned, exists.
// THROWS: Error{kBadInput}: a property that the mesh does not have; from reading: a corner that is no vertex, a
//         coordinate or value that is not finite.
std::unique_ptr<MeshReader> read_arrays(std::shared_ptr<const ArrayMesh> mesh, const ReadOptions& options);

}  // namespace reeb::python
