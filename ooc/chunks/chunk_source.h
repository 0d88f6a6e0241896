// The sources of the pipeline's chunks: an indexed mesh with known last uses, or a stream that finalizes its vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "libreeb/engine/stream_chunker.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/sweep/chunk.h"
#include "libreeb/sweep/fragment.h"
#include "ooc/chunks/function_values.h"
#include "ooc/chunks/last_use.h"

namespace reeb::ooc {

// How far a source has read, so that another process can resume there.
struct ChunkPlace {
  std::uint64_t triangles = 0;     // read so far
  std::uint64_t next_vertex = 0;   // the search for loose vertices continues here; of a stream: vertices read so far
  std::uint64_t batches = 0;       // of a stream, read so far; its end counts as one
  std::uint64_t chunk_blocks = 0;  // size of the next chunk, in the source's unit, where it adapts; 0: the first size.
                                   // Of a grid: the cells of a box along each axis
  std::uint64_t digest = 0;        // of what was read so far, as far as it is read again up to this place
  std::uint64_t completed = 0;     // vertices of an indexed mesh that chunks so far used last
  std::vector<ValueRange> ranges;  // of the values so far
};

// A chunk in the pipeline. Later chunks reuse its memory.
struct WorkItem {
  Chunk chunk;
  std::vector<std::vector<double>> values;  // one array per function
  std::vector<Fragment> fragments;          // one per function
  ChunkPlace end;                           // after this chunk, or after the stretch that it was cut from
  bool can_resume_after = true;             // a run can be resumed after this chunk
  void shrink_to_fit();
  std::size_t memory_bytes() const;
};

// How many triangles a chunk has, and how many vertices it may have.
struct ChunkSize {
  std::size_t first = 32768;  // of the first chunk
  std::size_t most = 524288;  // the limit of growth; equal to `first`: fixed
  // A chunk of more than `first` triangles is a stretch. It is cut into patches of at most this many
  // (divided_chunks.h).
  std::size_t patch = 32768;
  // Limits of vertices, for meshes with many vertices a triangle: a chunk of up to `first` triangles that has more than
  // this is cut into patches, too; and any chunk ends when it has more than `most_vertices`.
  std::size_t first_vertices = ~std::size_t{0};
  std::size_t most_vertices = ~std::size_t{0};
};

class ChunkSource {
 public:
  ChunkSource() = default;
  ChunkSource(const ChunkSource&) = delete;
  ChunkSource& operator=(const ChunkSource&) = delete;
  virtual ~ChunkSource() = default;

  // Fills chunk and values with the next chunk of the stream. False at the end.
  virtual bool next(WorkItem& item) = 0;
  // Whether the source stopped before the end of the mesh because it is not worth continuing in that order. The caller
  // then discards the results of its chunks.
  virtual bool given_up() const { return false; }
  // Bytes of input consumed so far, and in all (0: unknown).
  virtual std::uint64_t bytes_read() const = 0;
  virtual std::uint64_t bytes_total() const = 0;
  virtual std::uint64_t triangles_read() const = 0;  // of a stream that finalizes: simplices
  // What the mesh lists. Final once next() has returned false.
  virtual SimplexCounts simplices_listed() const = 0;
  // Of the whole mesh; for a stream, so far.
  virtual std::uint64_t vertex_count() const = 0;
  // More than the index of any vertex: indices have gaps where vertices of a grid are skipped.
  virtual std::uint64_t vertex_bound() const { return vertex_count(); }
};

// Chunks of an indexed mesh: whole blocks of its last-use table. Vertices that no triangle uses come last, as chunks of
// loose vertices. The sizes of chunks adapt (chunk_growth.h). The chunks before `start` are skipped.
// Every use of a vertex is checked against the table, and the triangles against its digest: chunks are right, or
// next() throws.
// REQUIRES: start.triangles is at a block's end.
// THROWS: Error{kChanged}, also from next(), if the table or `start` is of another mesh.
std::unique_ptr<ChunkSource> chunks_of(IndexedMesh& mesh, LastUse& last_use, FunctionValues& functions, ChunkSize size,
                                       const ChunkPlace& start = {});

// Chunks of a stream that is read once. Vertices that the stream does not finalize are finalized at its end. The input
// before `start` is read and skipped. If `most_active_vertices` is given, the source gives up as soon as more vertices
// than that are active (not finalized yet), or a large part of the vertices of a large mesh, or nearly all vertices
// that simplices used so far, if these are more than two layers of a volume, or more than fit the budget. What the
// reader holds is reserved from the budget, and so are the active vertices. THROWS, at once: Error{kChanged} if the
// stream does not match `start`.
std::unique_ptr<ChunkSource> chunks_of(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget,
                                       ChunkSize size, const ChunkPlace& start = {},
                                       std::optional<std::uint64_t> most_active_vertices = {});

}  // namespace reeb::ooc
