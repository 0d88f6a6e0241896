// What both stages of a run share.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/port/vertex_function.h"
#include "libreeb/sweep/sweep_options.h"
#include "ooc/checkpoints/resumable_run.h"
#include "ooc/chunks/function_values.h"
#include "ooc/reeb_writer/frame_writer.h"
#include "ooc/run/compute.h"
#include "ooc/run/memory_plan.h"
#include "ooc/segmentation/arc_follower.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

// The options of a sweep if a function's values were in this range so far. The range only grows, so noise below a share
// of it stays noise. REQUIRES: there was a value, or min = max = 0.
SweepOptions sweep_options(const ComputeOptions& options, const ValueRange& range);

// The first stage fills the stores and the ranges of the values; the second reads both. Everything else does not
// change.
struct RunContext {
  // Everything except `input` must outlive this.
  // THROWS: Error{kResource} if the budget is too small or a folder cannot be used; Error{kBadInput} if a file cannot
  //         be opened.
  RunContext(const MeshInput& input, std::span<VertexFunction* const> functions, std::span<const std::string> outputs,
             const ComputeOptions& options);

  // Goes back to the start of the run: nothing was stored, and no value was seen.
  void start_over();
  // Restores what an earlier process saved of the stores. If that is damaged, the stores are empty.
  void restore_stores(StateReader& in);
  // THROWS: Error{kChanged} if the mesh or a file of values changed since it was opened.
  void check_inputs() const;

  // THROWS: Error{kInterrupted} if the run is to end. While chunks are glued, interruption is checked between two
  //         chunks instead, where the run can be saved.
  void tell(const ComputeProgress& progress) const;

  bool embeds() const { return options.buckets != 0; }
  bool background() const { return plan.threads > 1; }
  OutputOptions output_options() const {
    // A run that is resumed may have written some of its outputs before.
    const bool replace = options.replace || resumable.was_resumed();
    return {replace ? io::Existing::kReplace : io::Existing::kKeep, temp.folder()};
  }

  const std::span<VertexFunction* const> functions;
  const std::span<const std::string> outputs;
  const ComputeOptions& options;
  const MeshSize size;     // of the mesh
  const unsigned threads;  // at most; a small budget has fewer: plan.threads
  const MemoryPlan plan;   // the plan while the front is not known
  MemoryBudget budget;
  const io::TempDir temp;
  FunctionValues values;
  ResumableRun resumable;
  std::vector<std::unique_ptr<SegmentStore>> stores;  // by function
  // Of a segmentation: gets the graph of the only function, in place of its store. The run cannot be resumed.
  std::unique_ptr<ArcFollower> follower;

 private:
  void make_stores();

  const std::function<void()> check_mesh_;
};

}  // namespace reeb::ooc
