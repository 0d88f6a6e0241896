// The checkpoints of a run: when to write them, where to resume, what to say when the run ends early.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
#include "ooc/checkpoints/checkpoint.h"
#include "ooc/checkpoints/partial_folder.h"

namespace reeb::ooc {

struct ResumeOptions {
  bool resume = false;                     // resume from a checkpoint that fits
  bool discard = true;                     // without `resume`: discard what an earlier run kept; false: refuse to run
  double seconds = 2;                      // least time between checkpoints; 0: after every chunk
  std::function<bool()> interrupted = {};  // called often: whether the run is to end
};

// One run to one output, or to several of which this is the first. Only a run on a mesh in a file can be resumed. For
// other runs this class handles interruptions only and creates no folder.
class ResumableRun {
 public:
  // What the stores and the engine save, in this order.
  using Save = std::function<void(StateWriter&)>;

  // Pass "" as `mesh` if the mesh is not, or only partly, in files.
  // THROWS: Error{kInterrupted} if the run is to end already; Error{kResource} of the folder; Error{kBadInput} if a
  //         file cannot be opened, or if there is a checkpoint that may not be discarded, and that is of another run or
  //         is not to be resumed. It stays.
  ResumableRun(const std::string& output, const std::string& mesh, std::span<VertexFunction* const> functions,
               const RunSettings& settings, const ResumeOptions& options);

  // The path without suffix for the segments of a function; empty if no process can resume with them.
  std::string segments_of(std::size_t function) const;

  // Returns the checkpoint to resume from if a resume was requested and a checkpoint fits; else removes everything that
  // an earlier run left. `restore` reads the state; if the state is damaged, there is no checkpoint. The reason is
  // added to `notes`.
  // THROWS: as io::File if a file of the checkpoint cannot be opened or read. The checkpoint stays.
  const Checkpoint* start(const std::function<void(StateReader&)>& restore, std::vector<std::string>& notes);
  // The same, until start_over().
  const Checkpoint* checkpoint() const { return load_.checkpoint ? &*load_.checkpoint : nullptr; }
  // Whether start() found a checkpoint to resume from.
  bool was_resumed() const { return was_resumed_; }
  // The part of the state that start() left unread: the engine. Null if there is no checkpoint to resume from.
  StateReader* saved_engine() const { return load_.state.get(); }

  // Discards what was run so far, and removes all that was kept of it.
  void start_over();

  // Whether the run is to end.
  bool is_interrupted() const { return options_.interrupted && options_.interrupted(); }

  // Whether checkpoints are written.
  bool can_be_saved() const { return folder_.has_value(); }
  // For places where nothing can be saved.
  // THROWS: Error{kInterrupted} if the run is to end.
  void check_interruption() const;

  // Between two chunks: saves if it is time to, or if the run is to end.
  // THROWS: Error{kInterrupted} if the run is to end. Failing to write a checkpoint is an error only then; before, the
  //         checkpoint is skipped.
  void between_chunks(const Checkpoint& here, const Save& save);

  // Returns the same error with a hint that says whether the run can be resumed. If it can, the folder stays; also if
  // the mesh has changed since an earlier run left it: only the user can discard that work.
  Error explain(const Error& error);
  // The outputs exist: removes the folder.
  void done();

 private:
  void refuse_to_discard(const std::string& mesh);

  using Clock = std::chrono::steady_clock;
  bool restores(const std::function<void(StateReader&)>& restore);
  bool is_due() const;

  ResumeOptions options_;
  std::optional<PartialFolder> folder_;
  RunIdentity identity_;
  CheckpointLoad load_;
  bool was_resumed_ = false;
  bool is_of_earlier_run_ = false;         // what is in the folder, or what it was resumed from
  Clock::time_point last_ = Clock::now();  // when the last checkpoint was made
  double cost_seconds_ = 0;                // of writing it
};

}  // namespace reeb::ooc
