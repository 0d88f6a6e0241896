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

// The options that the graph of a run, or its embedding, depends on.
struct RunSettings {
  double denoise = 0;
  std::uint64_t denoise_is_share = 0;
  std::uint64_t buckets = 0;
  std::uint64_t reading = 0;  // digest of the options by which the mesh is read
  std::uint64_t manifold = 0;
};

// The mesh, functions and settings of a run. It cannot use the checkpoint of a run with others.
struct RunIdentity {
  std::uint64_t mesh = 0;       // digest that identifies this state of the mesh
  std::uint64_t functions = 0;  // of names, and of the files that values come from
  std::uint64_t settings = 0;   // of the other options that the graph depends on
  std::uint64_t changed = 0;    // of the times at which anything about these files changed last
};

// THROWS: Error{kBadInput} if the mesh, or a file of values, cannot be opened.
RunIdentity identify_run(const std::string& mesh, std::span<VertexFunction* const> functions,
                         const RunSettings& settings);

// How a run gets its chunks. A resumed run gets them in the same way.
enum class ChunkOrigin : std::uint64_t {
  kLookedUp = 0,       // with known last uses
  kSorted = 1,         // with known last uses, after the mesh was sorted on disk
  kStream = 2,         // from a stream with finalization
  kGuessed = 3,        // while the mesh is read for the first time, with guesses
  kPieces = 4,         // with known last uses, its pieces in another order
  kSortedInSlabs = 5,  // as kSorted, in an order with a shorter front
  kGrid = 6,           // boxes of a grid
  kMaskedGrid = 7,     // the same with triangles, since vertices can be left out
};

// The state of a run apart from its stores and engine.
struct Checkpoint {
  ChunkPlace place = {};
  std::uint64_t block_triangles = 0;  // of the last-use table, if there is one
  ChunkOrigin origin = ChunkOrigin::kLookedUp;
  ChunkSize chunk = {};  // recorded for guesses, which are made at the ends of chunks
};

// Writes the file. It appears only when it is whole; an older one stays until then. `save` adds the state of the stores
// and of the engine. The content of the files that the state names must be on the device when `save` returns. Their
// names in the same folder then reach the device before the checkpoint gets its own name.
// THROWS: Error{kResource}.
void write_checkpoint(const std::string& path, const RunIdentity& run, const Checkpoint& checkpoint,
                      const std::function<void(StateWriter&)>& save);

struct CheckpointLoad {
  std::optional<Checkpoint> checkpoint;
  std::unique_ptr<StateReader> state;  // positioned at what `save` wrote
  std::string note;                    // why an existing file cannot be used; else empty
  bool is_of_another_run = false;      // which can use it
};

// Reads a checkpoint after verifying its checksum. A missing or damaged one, or one of another run, is not an error.
// THROWS: Error{kChanged} if the mesh looks the same but was changed: its time of modification was set back;
//         as io::File if the checkpoint cannot be opened or read.
CheckpointLoad load_checkpoint(const std::string& path, const RunIdentity& run);

}  // namespace reeb::ooc
