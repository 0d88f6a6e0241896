#include "ooc/checkpoints/resumable_run.h"

#include <algorithm>
#include <string_view>

#include "io/file/file.h"
#include "libreeb/base/count_text.h"

namespace reeb::ooc {
namespace {

// The share of the time since the last checkpoint that writing one may take.
constexpr double kTimeShare = 0.01;

}  // namespace

ResumableRun::ResumableRun(const std::string& output, const std::string& mesh,
                           std::span<VertexFunction* const> functions, const RunSettings& settings,
                           const ResumeOptions& options)
    : options_(options) {
  // From here on an interruption ends the run in order: it leaves no folder without a checkpoint.
  check_interruption();
  if (!io::is_regular_file(mesh) || io::is_device(output)) return;
  identity_ = identify_run(mesh, functions, settings);
  folder_.emplace(output);
  if (!options_.discard) refuse_to_discard(mesh);
}

// A checkpoint of another run with this output is hours of work, too. One that no run can use is not.
void ResumableRun::refuse_to_discard(const std::string& mesh) {
  CheckpointLoad load;
  try {
    load = load_checkpoint(folder_->checkpoint(), identity_);
  } catch (Error& error) {
    if (error.cause() != ErrorCause::kChanged) throw explain(error);
    throw error.at(mesh);
  }
  if (load.checkpoint && !options_.resume)
    throw Error(ErrorKind::kBadInput, "an interrupted run left what is needed to resume it",
                "continue it with --resume, or discard it with --force")
        .at(folder_->path());
  if (load.is_of_another_run)
    throw Error(ErrorKind::kBadInput,
                "an interrupted run with another mesh, part, function or option left its state here",
                "choose another output with -o, or discard that run with --force")
        .at(folder_->path());
}

std::string ResumableRun::segments_of(std::size_t function) const {
  return folder_ ? folder_->file("function-" + std::to_string(function)) : "";
}

const Checkpoint* ResumableRun::start(const std::function<void(StateReader&)>& restore,
                                      std::vector<std::string>& notes) {
  last_ = Clock::now();
  if (options_.resume && !folder_)
    notes.push_back(
        "a run that reads no regular file or writes snapshots cannot be resumed; it starts from the beginning");
  if (!folder_) return nullptr;
  if (options_.resume) {
    is_of_earlier_run_ = folder_->has_checkpoint();
    load_ = load_checkpoint(folder_->checkpoint(), identity_);
    if (!load_.checkpoint && load_.note.empty())
      load_.note = "there is nothing to resume, so the run starts from the beginning";
    if (load_.checkpoint && restores(restore)) {
      notes.push_back("an earlier run had read " + count_of(load_.checkpoint->place.triangles, "triangle") +
                      "; this one continues from there");
      was_resumed_ = true;
      return checkpoint();
    }
    notes.push_back(load_.note);
  }
  folder_->clear();
  is_of_earlier_run_ = false;
  return nullptr;
}

// A file that is there but cannot be opened or read is no damage: it may be readable the next time.
bool ResumableRun::restores(const std::function<void(StateReader&)>& restore) {
  try {
    restore(*load_.state);
    return true;
  } catch (const DamagedState&) {
  } catch (const Error& error) {
    if (error.cause() != ErrorCause::kMissing || !error.file().starts_with(folder_->path())) throw;
  }
  load_ = {};
  load_.note = "the files of the checkpoint are damaged or missing, so the run starts from the beginning";
  return false;
}

void ResumableRun::start_over() {
  load_ = {};
  is_of_earlier_run_ = false;
  if (folder_) folder_->clear();
}

void ResumableRun::check_interruption() const {
  if (is_interrupted()) throw Error(ErrorKind::kInterrupted, "interrupted", "run it again");
}

void ResumableRun::between_chunks(const Checkpoint& here, const Save& save) {
  const bool to_end = is_interrupted();
  if (folder_ && (to_end || is_due())) {
    const Clock::time_point begin = Clock::now();
    try {
      folder_->sync_name();
      write_checkpoint(folder_->checkpoint(), identity_, here, save);
    } catch (const Error&) {
      if (to_end) throw;
    }
    last_ = Clock::now();
    cost_seconds_ = std::chrono::duration<double>(last_ - begin).count();
  }
  if (to_end) check_interruption();
}

bool ResumableRun::is_due() const {
  if (options_.seconds == 0) return true;
  const double since = std::chrono::duration<double>(Clock::now() - last_).count();
  return since >= std::max(options_.seconds, cost_seconds_ / kTimeShare);
}

Error ResumableRun::explain(const Error& error) {
  if (!folder_) return error;
  ErrorKind kind = error.kind();
  std::string hint = error.hint();
  // The files that grow in this folder are not in the temporary folder. None of them is an input.
  if (error.file().starts_with(folder_->path())) {
    constexpr std::string_view kElsewhere = io::kOtherTempFolderHint, kOutput = "choose another output with -o";
    if (kind == ErrorKind::kBadInput) hint = "check the disk, or " + std::string(kOutput);
    if (const auto at = hint.find(kElsewhere); at != hint.npos) hint.replace(at, kElsewhere.size(), kOutput);
    kind = ErrorKind::kResource;
  }
  // The mesh can be brought back, and a disk may work again. Otherwise running again would fail in the same way.
  const bool keeps =
      error.cause() == ErrorCause::kUnreadable || (is_of_earlier_run_ && error.cause() == ErrorCause::kChanged);
  if (kind == ErrorKind::kBadInput && !keeps) {
    folder_->clear();
  } else if (error.cause() != ErrorCause::kChanged && folder_->has_checkpoint()) {
    const std::string go_on = "the same command with --resume continues the run";
    hint = kind == ErrorKind::kInterrupted ? go_on : hint + "; then " + go_on;
  } else if (kind == ErrorKind::kInterrupted) {
    hint = "run it again, with --force if an output was written; nothing was kept to resume it";
  }
  Error explained(kind, error.message(), hint);
  return explained.at(error.file(), error.position()).because(error.cause());
}

void ResumableRun::done() {
  if (folder_) folder_->clear();
  folder_.reset();
}

}  // namespace reeb::ooc
