// OFF (Geomview): [ST][C][N][4][n]OFF, ASCII (float64) and "BINARY" (big endian, float32).
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

#include "io/file/content_source.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

// The keyword at the head of an OFF file.
struct OffKind {
  bool texture = false, colours = false, normals = false, four = false, any_dimension = false;
  bool binary = false;

  // The number of values of a binary vertex after its `dimension` coordinates.
  std::size_t extra_numbers(std::size_t dimension) const {
    return (normals ? dimension : 0) + (colours ? 4 : 0) + (texture ? 2 : 0);
  }
};

// Nothing if the word is not the keyword of an OFF file.
std::optional<OffKind> parse_off_keyword(std::string_view word);

// THROWS: Error{kBadInput} as open_mesh.
std::unique_ptr<MeshReader> open_off(std::unique_ptr<ContentSource> source, const ReadOptions& options);

}  // namespace reeb::io
