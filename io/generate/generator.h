// Test meshes of any size, computed while they are read: only one batch is stored.
//
// Vertices, positions and triangles are functions of their index alone, so a mesh of 372M triangles takes no more
// memory than one of a thousand. Its topology is known by construction, for comparison in tests and benchmarks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

enum class MeshKind {
  kTorus,       // stands on its side: the function z has one loop
  kTerrain,     // a disc: a height field of fractal noise
  kGrid,        // a disc: flat, x and y integers, z = 0; every sweep meets ties
  kPlate,       // closed: a flat plate with a through-hole in every 4 x 4 cells
  kScan,        // closed: a rough, noisy body of two close sheets with many small handles
  kSierpinski,  // the 2-skeleton of a Sierpinski simplex of dimension 2 to 5; not a manifold
  kBall,        // tetrahedra: a ball with tunnels drilled through it; the function z has a loop for each
};

enum class MeshOrder {
  kRows,     // vertices and triangles row by row: the front is one row
  kPatches,  // square patches, row of patches by row of patches; vertices numbered patch by patch
  kRandom,   // vertices in rows, triangles in pseudo-random order
  // As patches, of any size. They stand for scans that were merged from pieces. On grids only.
  kTiles,
  kRandomTiles,  // vertices as in kTiles; the triangles of a tile together, the tiles in pseudo-random order
  kSeamsLast,    // as kTiles, but the triangles that join a tile to the next ones come after those of all tiles
};

struct GeneratorOptions {
  MeshKind kind = MeshKind::kScan;
  std::uint64_t triangles = 1'000'000;   // the mesh has the nearest count that its kind and width allow
  std::uint64_t tetrahedra = 1'000'000;  // of a ball, instead
  std::uint64_t handles = 1;             // of a ball
  MeshOrder order = MeshOrder::kPatches;
  std::uint64_t tile_cells = 32;         // along a side of a tile, for orders in tiles
  std::uint64_t seed = 1;                // of noise, positions of handles, and random order
  std::optional<std::uint64_t> width{};  // cells in a row of the grid; default: about as many as rows
  unsigned dimension = 3;                // of the Sierpinski simplex
  // Of a Sierpinski simplex: its simplices as they are, with as many coordinates as dimensions; else their triangles,
  // with at least three coordinates.
  bool whole_cells = false;
};

struct ExpectedTopology {
  std::uint64_t vertices = 0, triangles = 0, tetrahedra = 0;  // of a ball no triangles, otherwise no tetrahedra
  std::uint64_t components = 1;
  std::int64_t euler_characteristic = 0;  // of the 2-skeleton; of a ball, of all
  std::uint64_t first_betti = 0;
  std::optional<std::uint64_t> genus;           // orientable surfaces
  std::optional<std::uint64_t> boundary_loops;  // manifolds
  // No Reeb graph of the mesh has more loops. On a closed orientable surface, every function with simple saddles only
  // has exactly this number.
  std::uint64_t max_reeb_loops = 0;
};

class GeneratedMesh : public MeshReader {
 public:
  virtual const ExpectedTopology& topology() const = 0;
};

// A reader of the mesh that the options describe. All numbers are exact in float32. The mesh depends on kind, counts,
// seed, width and dimension only; the order only renumbers vertices and permutes triangles or tetrahedra.
// THROWS: Error{kUsage} for options that no mesh can have.
std::unique_ptr<GeneratedMesh> generate_mesh(const GeneratorOptions& options, const ReadOptions& read_options = {});

// By the name on the command line ("scan"). THROWS: Error{kUsage} that lists the names.
MeshKind mesh_kind(std::string_view name);
// Sets the order by its name on the command line: "patches", or "tiles:N" with N cells along the side of a tile.
// THROWS: Error{kUsage}.
void set_order(GeneratorOptions& options, std::string_view name);

}  // namespace reeb::io
