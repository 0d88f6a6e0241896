// The state of the first stage between two chunks, in one file (docs/FORMAT.md, The partial folder).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "libreeb/base/state_stream.h"
#include "ooc/chunks/chunk_source.h"

namespace reeb::ooc {

// What of a run's options its graph depends on, or its embedding.
struct RunSettings {
  double denoise = 0;
  std::uint64_t denoise_is_share = 0;
  std::uint64_t buckets = 0;
};

// What a run works on. A checkpoint of another run is of no use to it.
struct RunIdentity {
  std::uint64_t mesh = 0;       // digest of what tells this state of the mesh from others
  std::uint64_t functions = 0;  // of names, and of the files that values come from
  std::uint64_t settings = 0;   // of what else decides about the graph
};

// THROWS: Error{kBadInput} if the mesh, or a file of values, cannot be opened.
RunIdentity identify_run(const std::string& mesh, std::span<VertexFunction* const> functions,
                         const RunSettings& settings);

// How a run gets its chunks. One that goes on gets them in the same way.
enum class ChunkOrigin : std::uint64_t {
  kLookedUp = 0,  // with known last uses
  kSorted = 1,    // the same, once the mesh was sorted on disk
  kStream = 2,    // from a stream with finalization
  kGuessed = 3,   // while the mesh is read for the first time, with guesses
};

// Where the run was.
struct Checkpoint {
  ChunkPlace place = {};
  std::uint64_t block_triangles = 0;  // of the last-use table, if there is one
  ChunkOrigin origin = ChunkOrigin::kLookedUp;
  ChunkSize chunk = {};  // with guesses: they are made at the ends of chunks
};

// Writes the file; it appears only when whole, and an older one stays until then. `save` adds what
// the stores and the engine hold; the content of the files that they name must be on the device when it
// returns, and their names in the same folder then get there before the checkpoint has its own.
// THROWS: Error{kResource}.
void write_checkpoint(const std::string& path, const RunIdentity& run, const Checkpoint& checkpoint,
                      const std::function<void(StateWriter&)>& save);

struct CheckpointLoad {
  std::optional<Checkpoint> checkpoint;
  std::unique_ptr<StateReader> state;  // stands at what `save` wrote
  std::string note;                    // why a file that is there is of no use; empty if there is none
};

// Reads a checkpoint, once its checksum was found right. One that is missing, of another run or
// damaged is not an error.
CheckpointLoad load_checkpoint(const std::string& path, const RunIdentity& run);

}  // namespace reeb::ooc
