// The first stage in parallel: read -> sweep -> glue in order -> write out.
//
// Several threads sweep chunks; one at a time glues them in stream order. The number of chunks in flight is fixed, so
// the queue cannot grow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/engine/glue.h"
#include "libreeb/port/arc_log.h"
#include "libreeb/port/graph_sink.h"
#include "libreeb/sweep/sweep_options.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/run/compute_result.h"

namespace reeb::ooc {

// Writes the state that the pipeline needs to resume between two chunks.
using SaveEngine = std::function<void(StateWriter&)>;

// Chooses how to sweep a chunk, from the number of a function and the range of its values up to the end of the chunk.
// Several threads call it.
using ChooseSweep = std::function<SweepOptions(std::size_t function, const ValueRange& range)>;

// How much the source had read after it read a chunk.
struct SourceProgress {
  std::uint64_t bytes_read = 0, bytes_total = 0, triangles_read = 0;
};

struct PipelineOptions {
  unsigned threads = 1;
  bool are_boxes = false;         // all chunks are boxes of a grid, in the order of GridBoxes
  ChooseSweep choose_sweep = {};  // empty: the graph alone
  // Called in order after each chunk was glued. May throw to stop the run.
  std::function<void(const SourceProgress&)> progress = {};
  // Called after that if the run can be resumed after this chunk: with the place after the chunk, and a function that
  // saves what was glued up to there.
  std::function<void(const ChunkPlace&, const SaveEngine&)> between_chunks = {};
  // Of a run with one function, whose chunks are not boxes: gets the history of arcs. Null: none.
  ArcLog* log = nullptr;
  // The state that an earlier process saved; the source starts at its place.
  StateReader* saved_engine = nullptr;
  // Of a run whose chunks are not boxes: called at the end for each function, with all that was glued.
  std::function<void(std::size_t function, const Glue&)> at_end = {};
};

struct PipelineResult {
  LiveMaximum live;
  std::vector<std::uint64_t> removed_pairs;  // as noise, by function
  std::uint64_t restored_vertex_bound = 0;   // more than the id of any vertex in saved_engine
};

// Runs all chunks of `source`. The graph of function i goes to sinks[i], which one thread at a time calls in stream
// order. The graph does not depend on threads or chunks. The embedding and the noise removed do not depend on threads.
// THROWS: what the source and the sinks throw; DamagedState of saved_engine; Error{kResource} when the budget is too
// small.
PipelineResult run_pipeline(ChunkSource& source, std::span<GraphSink* const> sinks, MemoryBudget& budget,
                            const PipelineOptions& options);

}  // namespace reeb::ooc
