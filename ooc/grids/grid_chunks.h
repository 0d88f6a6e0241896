// Chunks of a grid: boxes (docs/ARCHITECTURE.md, Grids).
#pragma once

#include <cstddef>
#include <memory>

#include "libreeb/base/memory_budget.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/function_values.h"

namespace reeb::ooc {

// Reads the grid layer by layer, and cuts each layer into boxes of at most about `box_vertices`, which carry values and
// no simplices. The layers before `start` are read and skipped. A run can be resumed after a layer.
// MEMORY: reserved: the values of a layer, at least two slices.
// REQUIRES: the reader leaves out simplices, and no vertices.
// THROWS, at once: Error{kChanged} if the grid does not match `start`; Error{kResource} of the budget.
std::unique_ptr<ChunkSource> chunks_of_grid(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget,
                                            std::size_t box_vertices, const ChunkPlace& start = {});

// The same for a grid of which some vertices can be left out. Boxes have at most about `box_triangles` triangles, and
// carry them.
// MEMORY: reserved: the values of a layer, a byte for each of its vertices, and two slices of a byte a vertex.
// REQUIRES: the reader leaves out simplices.
std::unique_ptr<ChunkSource> chunks_of_masked_grid(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget,
                                                   std::size_t box_triangles, const ChunkPlace& start = {});

}  // namespace reeb::ooc
