// Checkpoints along a run: when to make them, where to go on, what to say when the run ends early
// (DESIGN.md 4).
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
#include "ooc/run/checkpoint.h"
#include "ooc/run/partial_folder.h"

namespace reeb::ooc {

struct ResumeOptions {
  bool resume = false;                     // go on from a checkpoint that fits
  double seconds = 2;                      // between checkpoints, at least; 0: after every chunk
  std::function<bool()> interrupted = {};  // asked often: is the run to end?
};

// One run to one output, or to several of which this is the first. Only a run on a mesh that is a
// file can be gone on with; for others this answers interruptions, and no folder is made.
class ResumableRun {
 public:
  // What the stores and the engine save, in this order.
  using Save = std::function<void(StateWriter&)>;

  // A mesh of which only part is kept in files, or none, is `mesh` = "".
  // THROWS: Error{kResource} of the folder; Error{kBadInput} if a file cannot be opened.
  ResumableRun(const std::string& output, const std::string& mesh, std::span<VertexFunction* const> functions,
               const RunSettings& settings, const ResumeOptions& options);

  // Path without suffix for the segments of a function; empty if nobody can go on with them.
  std::string segments_of(std::size_t function) const;

  // The checkpoint to go on from, if one was asked for and fits; else all that an earlier run left
  // is removed. The state is read by `restore`; if it is damaged, that counts as no checkpoint.
  // Why there is none is added to `notes`.
  const Checkpoint* start(const std::function<void(StateReader&)>& restore, std::vector<std::string>& notes);
  // The same, until start_over().
  const Checkpoint* checkpoint() const { return load_.checkpoint ? &*load_.checkpoint : nullptr; }
  // What start() left unread: the engine. Null if there is no checkpoint to go on from.
  StateReader* saved_engine() const { return load_.state.get(); }

  // What was run so far was of no use: all that was kept of it is removed.
  void start_over();

  // At a place where nothing can be saved.
  // THROWS: Error{kInterrupted} if the run is to end.
  void check_interruption() const;

  // Between two chunks: saves if it is time to, and if the run is to end.
  // THROWS: Error{kInterrupted} if the run is to end. A checkpoint that cannot be written is an
  //         error only then; before, it is left out.
  void between_chunks(const Checkpoint& here, const Save& save);

  // The same error with a hint that says what can be gone on with. The folder stays if that is so.
  Error explain(const Error& error);
  // The outputs are there: the folder goes.
  void done();

 private:
  using Clock = std::chrono::steady_clock;
  bool restores(const std::function<void(StateReader&)>& restore);
  bool is_due() const;

  ResumeOptions options_;
  std::optional<PartialFolder> folder_;
  RunIdentity identity_;
  CheckpointLoad load_;
  Clock::time_point last_ = Clock::now();  // when the last checkpoint was made
  double cost_seconds_ = 0;                // of it
};

}  // namespace reeb::ooc
