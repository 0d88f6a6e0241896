// The header of a PLY file: its elements and properties, and the role of each in a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/mesh/scalar_bytes.h"
#include "io/text/text_cursor.h"

namespace reeb::io {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::kFloat32;  // of the value, or of the items of the list
  std::optional<ScalarType> list_count;    // the type of the length, if it is a list
};

enum class PlyRole { kSkipped, kVertices, kFaces, kStrips };

struct PlyElement {
  std::string name;
  PlyRole role = PlyRole::kSkipped;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::size_t corners = 0;  // for faces and strips: the property that lists the corners

  // Bytes of a binary record without its list items: the size of the record if it has no lists.
  std::size_t fixed_bytes() const;
  bool has_lists() const;
};

// Where faces are if all of them are triangles.
struct PlyTriangles {
  std::size_t element = 0;
  std::uint64_t offset = 0;  // of the first
  std::size_t bytes = 0;     // of each
  std::uint64_t count = 0;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;  // without those that have no properties
  std::size_t vertex_element = 0;
  unsigned dimension = 3;  // how many of x, y, z exist, from the first
  std::uint64_t body_offset = 0;
  std::uint64_t unknown_lines = 0;  // lines that are not PLY, such as a comment without the word comment

  const PlyElement& vertices() const { return elements[vertex_element]; }
  std::string format() const;
  std::vector<std::string> property_names() const;
  // The index of each name among the vertex properties.
  // THROWS: Error{kBadInput} naming the scalar properties that exist.
  std::vector<std::size_t> find_properties(const std::vector<std::string>& names, const std::string& file) const;
  // If a binary file of `file_bytes` has the size of one in which all faces are triangles.
  std::optional<PlyTriangles> triangles_by_size(std::uint64_t file_bytes) const;
  // The indices of the coordinates among the vertex properties.
  std::vector<std::size_t> coordinate_properties() const;
};

// Reads up to and including the line end_header. If the size of the input is known, checks that it is large enough for
// the elements.
// THROWS: Error{kBadInput} with the line.
PlyHeader read_ply_header(TextCursor& text);

}  // namespace reeb::io
