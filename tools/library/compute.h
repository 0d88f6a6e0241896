// From a mesh in a file to its Reeb graph in a file, in one call: what the program `reeb compute` does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/formats/open_mesh.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/run/compute_result.h"

namespace reeb {

using ooc::ComputeProgress;
using ooc::ComputeResult;

inline constexpr unsigned kMostThreads = 1024;

struct ComputeOptions {
  std::uint64_t memory_bytes = ~std::uint64_t{0};  // what the run may use; default: no limit
  unsigned threads = 0;                            // 0: all that the machine has, but one for a small mesh
  bool replace = false;                            // outputs that exist, and an interrupted run; else an Error
  bool graph_only = false;                         // no pairs and levels
  // Minima and maxima of less persistence are removed; `denoise` is a share of the function's range (0.001
  // is 0.1%), or in units of the function. 0: all stay. A finite number from 0 on.
  double denoise = 0;
  bool denoise_is_share = false;
  // Promises that no edge has more than two triangles, which saves work; a third one is an Error{kBadInput}.
  bool manifold = false;
  // Buckets of value over the range, at least; at most twice that. 0: none. Up to kMostBuckets.
  std::uint32_t buckets = 64;
  std::string format{};              // of the mesh, where its content does not tell: "cx", ...; empty: detected
  io::ImageOptions image{};          // how an image is read
  std::string temp_dir{};            // for temporary files; empty: $TMPDIR, or the folder of the first output
  bool may_reorder = true;           // sort an incoherent mesh on disk first
  bool keep_sidecar = false;         // keep what the first pass learns in MESH.final, for the next run
  std::size_t chunk_triangles = 0;   // 0: adaptive
  std::uint64_t snapshot_every = 0;  // write the graph so far after every N simplices; 0: never
  // Continue an interrupted run with the same mesh, functions and first output.
  bool resume = false;
  bool keeps_checkpoints = true;  // so that an interrupted run can be resumed
  double checkpoint_seconds = 2;  // between two checkpoints, at least; 0: after every chunk
  // Called by one thread at a time, not always the same. They may throw: that ends the run.
  std::function<void(const MeshInfo&)> opened{};           // once, before the first triangle
  std::function<void(const ComputeProgress&)> progress{};  // often
  std::function<bool()> interrupted{};                     // often: true ends the run with Error{kInterrupted}
};

// Computes the Reeb graph of the mesh `path` ("-": standard input) for a function ("z", "c3", "index",
// "random:1", "property:NAME", "file:PATH", ..., as the program's -f; "": the program's default) and writes it to
// `output` with all levels of detail; ReebFile reads that. The output "-" is standard output. Format and compression
// are told by content. Threads do not change the bytes of the result; with buckets = 0, memory and chunks do not
// either.
//
// THROWS:  Error: kUsage for an unknown function or an option out of its limits; kBadInput with file and position for a
//          bad mesh, or an output that exists, is an input or is another output; kResource if memory or disk do not
//          suffice, or an output cannot be created; kInterrupted. All of outputs is checked before any work. No output
//          is ever written in part, but those of earlier functions may be there, and the graph alone if its levels did
//          not fit the memory. Of the last two kinds the hint says whether options.resume can continue.
// TIME:    about 60 ns a triangle where the order of the mesh is coherent; one or two readings of the file.
// MEMORY:  tens of MiB for the chunks, and the front of the sweep; with levels also the graph, 91 to 167 bytes an arc.
//          options.memory_bytes bounds it.
// THREADS: starts options.threads of its own, and may be called by several threads at once for different
//          outputs.
ComputeResult compute(const std::string& path, const std::string& function, const std::string& output,
                      const ComputeOptions& options = {});

// Several functions in one reading of the mesh: the graph of functions[i] goes to outputs[i].
// REQUIRES: one output a function, and at least one; else Error{kUsage}.
std::vector<ComputeResult> compute(const std::string& path, std::span<const std::string> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options = {});

// Opens a mesh that the caller holds, at its beginning, as often as it is called. A reader that it returned earlier can
// still be in use.
using MeshOpener = std::function<std::unique_ptr<MeshReader>(const ReadOptions&)>;

// The same for a mesh that is in no file, as in arrays of the caller. Such a run keeps no sidecar and cannot be
// resumed. options.format and options.image have no effect. A reader that breaks a rule of mesh_reader.h is an
// Error{kBadInput}.
std::vector<ComputeResult> compute(const MeshOpener& mesh, std::span<const std::string> functions,
                                   std::span<const std::string> outputs, const ComputeOptions& options = {});

}  // namespace reeb
