// Functions on the vertices of a mesh, as a user names them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

struct FunctionSpec {
  enum class Kind {
    kCoordinate,
    kIndex,
    kRandom,
    kProperty,
    kValue,
    kFile,
    kDistanceToVertex,
    kDistanceToPoint,
    kGeodesic,
    kLaplacian
  };

  Kind kind = Kind::kCoordinate;
  std::uint64_t number = 2;               // of the coordinate, the vertex or the eigenvector; or the seed
  std::string argument{};                 // the property, the value of an image, or the path
  std::string text = "z";                 // as the user wrote it
  std::array<double, 3> point{};          // to which the distance is measured
  std::vector<std::uint64_t> vertices{};  // from which a geodesic is measured

  // Whether all of the mesh must be known before the first value.
  bool needs_field() const { return kind == Kind::kGeodesic || kind == Kind::kLaplacian; }
};

// THROWS: Error{kUsage} that lists the functions.
FunctionSpec parse_function(std::string_view text);

// What is computed where no function is named: the value of an image, else z, or the last coordinate where there are
// fewer than three.
FunctionSpec default_function(const MeshInfo& info);

// The text of a function as part of a file name: ':' and '/' become '-'.
std::string file_name_part(const FunctionSpec& spec);

// What ReadOptions::properties must contain for these functions; each name once.
std::vector<std::string> needed_properties(std::span<const FunctionSpec> specs);

}  // namespace reeb::io
