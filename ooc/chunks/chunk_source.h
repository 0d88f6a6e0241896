// Where the pipeline's chunks come from: an indexed mesh with known last uses, or a stream that
// brings its finalization with it (DESIGN.md 3, 4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "libreeb/engine/chunk.h"
#include "libreeb/engine/fragment.h"
#include "libreeb/engine/stream_chunker.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/chunks/function_values.h"
#include "ooc/chunks/last_use.h"

namespace reeb::ooc {

// How far a source has come, for another process to go on from there.
struct ChunkPlace {
  std::uint64_t triangles = 0;        // read so far
  std::uint64_t next_vertex = 0;      // from which on loose vertices are looked for; of a stream: read so far
  std::uint64_t batches = 0;          // of a stream, read so far, its end counted as one
  std::uint64_t chunk_blocks = 0;     // of the next chunk, where its size adapts; 0: to start with
  std::vector<FunctionRange> ranges;  // of the values so far
};

// A chunk on its way through the pipeline; its memory is reused by later ones.
struct WorkItem {
  Chunk chunk;
  std::vector<std::vector<double>> values;  // one array a function
  std::vector<Fragment> fragments;          // one a function
  ChunkPlace end;                           // behind this chunk, or the stretch that it was cut from
  bool ends_stretch = true;                 // a run can go on from behind this chunk
  void shrink_to_fit();
  std::size_t memory_bytes() const;
};

// How many triangles a chunk has.
struct ChunkSize {
  std::size_t first = 32768;  // to start with
  std::size_t most = 524288;  // as far as it may grow; equal to `first`: fixed
  // One of more than `first` is a stretch, to be cut into patches of at most so many
  // (divided_chunks.h).
  std::size_t patch = 32768;
};

class ChunkSource {
 public:
  ChunkSource() = default;
  ChunkSource(const ChunkSource&) = delete;
  ChunkSource& operator=(const ChunkSource&) = delete;
  virtual ~ChunkSource() = default;

  // Fills chunk and values with the next chunk of the stream. False at the end.
  virtual bool next(WorkItem& item) = 0;
  // Whether the chunks ended before the mesh did, since it is not worth going on in its order: what
  // came of them is then to be thrown away.
  virtual bool given_up() const { return false; }
  // Bytes of input consumed so far, and in all (0: unknown).
  virtual std::uint64_t bytes_read() const = 0;
  virtual std::uint64_t bytes_total() const = 0;
  virtual std::uint64_t triangles_read() const = 0;
  // Of the whole mesh; for a stream, so far.
  virtual std::uint64_t vertex_count() const = 0;
};

// Chunks of an indexed mesh: whole blocks of its last-use table. Vertices that no triangle uses
// come last, as chunks of loose vertices. A chunk grows while too many of its vertices are shared
// with others, since gluing is what such a chunk costs. The chunks before `start` are passed over.
// REQUIRES: start.triangles is at a block's end.
std::unique_ptr<ChunkSource> chunks_of(IndexedMesh& mesh, LastUse& last_use, FunctionValues& functions, ChunkSize size,
                                       const ChunkPlace& start = {});

// Chunks of a stream, read once. What is not finalized by the stream is finalized at its end. What
// comes before `start` is read and passed over. It gives up, if it may at all, once more vertices than
// that are active (not finalized yet), or a large part of many.
// THROWS, at once: Error{kBadInput} if the stream has not such a place.
std::unique_ptr<ChunkSource> chunks_of(MeshReader& reader, FunctionValues& functions, ChunkSize size,
                                       const ChunkPlace& start = {},
                                       std::optional<std::uint64_t> most_active_vertices = {});

}  // namespace reeb::ooc
