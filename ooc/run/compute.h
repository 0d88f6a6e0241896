// The central function: from a mesh to the files of its Reeb graphs, within a memory budget.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_function.h"
#include "ooc/run/compute_result.h"

namespace reeb::ooc {

// Sizes of meshes that a run treats differently.
enum class MeshSize : std::uint8_t {
  kTiny,   // a run takes little more memory than the program by itself
  kSmall,  // a second thread saves less than it takes to start, and would cost 4 MB
  kAny,
};

// A mesh in one of two forms. An indexed mesh is read twice, or once if it seems to be closed and guesses of what is
// complete hold. A reader is read once: as a stream if it finalizes its vertices; else finalization is guessed, and a
// copy of the mesh is kept on disk, from which it is run again if a guess was wrong. If too many vertices of a stream
// are live at once, it is read again, if that is possible, and sorted on disk.
struct MeshInput {
  std::unique_ptr<IndexedMesh> indexed;
  std::unique_ptr<MeshReader> reader;
  std::function<std::unique_ptr<MeshReader>()> read_again;  // starts over at the first batch; or empty
  unsigned dimension = 3;
  std::uint64_t reader_bytes = 0;  // what the reader holds to unpack the input
  std::string path;                // for the sidecar, checkpoints and messages; "-": none
  // Throws Error{kChanged} if what was read so far does not fit together; empty: nothing can change.
  std::function<void()> check_unchanged = {};
  std::uint64_t reading = 0;  // digest of the options by which it is read
  MeshSize size = MeshSize::kAny;
  bool may_resume = true;  // a later process can read the file at `path` in the same batches
};

struct ComputeOptions {
  std::uint64_t memory_bytes = MemoryBudget::kUnlimited;
  unsigned threads = 1;             // 0: all of the machine, but one for a small mesh
  std::size_t chunk_triangles = 0;  // 0: adaptive
  // With a chosen size of chunks: they are cut from stretches that grow up to this many triangles.
  std::size_t stretch_triangles = 0;
  std::string temp_dir;  // empty: $TMPDIR, or the folder of the first output
  // Outputs that exist are replaced, and a run that was interrupted is discarded unless it is resumed. Else both are an
  // Error{kBadInput}.
  bool replace = true;
  bool graph_only = false;
  bool keep_sidecar = false;
  bool may_reorder = true;        // may sort a mesh on disk that has no coherent pieces
  bool may_guess = true;          // may guess complete vertices of a reader without finalization
  std::uint32_t buckets = 64;     // K: K to 2K buckets span the range of a function; 0: no embedding
  bool manifold = false;          // no edge has more than two triangles; else Error{kNotManifold}
  double denoise = 0;             // remove noise below this persistence; 0: keep all
  bool denoise_is_share = false;  // `denoise` is a share of the function's range
  std::function<void(const ComputeProgress&)> progress = {};
  // A run on a mesh in a file keeps checkpoints in the folder OUT.partial. A later run with the same mesh, functions
  // and first output can resume from them; the result is the same.
  bool resume = false;
  double checkpoint_seconds = 2;  // least time between checkpoints; 0: after every chunk
  // Called often, by several threads, also at the same time: whether the run is to end.
  std::function<bool()> interrupted = {};
};

// Computes the graph of functions[i] and writes it to outputs[i]. All functions share the pass over the mesh in which
// it is glued. If last uses must be found or the mesh must be sorted first, the mesh is also read before that pass.
//
// THROWS: Error; Error{kChanged} if the mesh or a file of values changes meanwhile. No output is ever partly written,
//         but some outputs may exist: those of earlier functions; and the graph alone, if kResource says that memory
//         did not suffice for a function's hierarchy or the end of its noise removal. For kResource and kInterrupted
//         the hint says whether a later run can resume this one.
std::vector<ComputeResult> compute(MeshInput input, std::span<VertexFunction* const> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options);

}  // namespace reeb::ooc
