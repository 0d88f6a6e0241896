// Cuts a mesh into pieces: stretches of consecutive triangles that lie near each other.
//
// Large scans are merged from pieces. Each is in a coherent order of its own, but the pieces can be in any order. Then
// nothing has to be sorted: it suffices to visit the pieces in another order (piece_order.h).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/port/indexed_mesh.h"

namespace reeb::ooc {

struct MeshPiece {
  MeshPlace place;         // of its first triangle
  std::uint64_t rank = 0;  // set and used by order_pieces()
  std::array<float, 3> centre;
  std::uint32_t triangles = 0;
};

struct MeshPieces {
  std::vector<MeshPiece> pieces;      // in the order of the mesh
  std::array<double, 3> sides{};      // of the box of a piece, the mean over the triangles
  Reservation memory;                 // 40 bytes per piece, and 8 to order them
  std::vector<std::string> warnings;  // of the mesh, read to its end
};

struct PieceOptions {
  unsigned coordinates = 3;             // the number of leading columns that are coordinates; at most 3 are used
  std::uint32_t most_triangles = 4096;  // of a piece
  std::uint64_t most_pieces = ~std::uint64_t{0};
  // Called about once per piece, with the number of bytes of the mesh read so far.
  std::function<void(std::uint64_t)> progress = {};
};

// A piece ends where the next triangle is far from the box of the piece, or the box gets large, compared with the edges
// of triangles near by; and when it is full. The position of a triangle is that of its first corner.
//
// Returns nothing if the mesh has no places to return to, or if pieces would be too small (few triangles) or too many.
// The result depends on the mesh only, and on most_triangles.
//
// THROWS: what reading the mesh throws; Error{kResource} of the budget.
// TIME: a look-up per triangle. On a mesh in random order it ends after a few.
std::optional<MeshPieces> cut_into_pieces(IndexedMesh& mesh, MemoryBudget& budget, const PieceOptions& options = {});

}  // namespace reeb::ooc
