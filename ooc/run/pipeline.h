// The first stage in parallel: read -> sweep -> glue in order -> hand over (DESIGN.md 3).
//
// Chunks are swept by several threads and glued in stream order by one at a time. A fixed number
// of chunks is in flight, so the queue cannot become the memory use.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/base/state_stream.h"
#include "libreeb/engine/sweep_options.h"
#include "libreeb/port/graph_sink.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/run/compute_result.h"

namespace reeb::ooc {

// Writes what the pipeline needs to go on from between two chunks.
using SaveEngine = std::function<void(StateWriter&)>;

// What to do with a chunk, from a function's number and the range of its values up to and with the
// chunk. Called by several threads.
using ChooseSweep = std::function<SweepOptions(std::size_t function, const FunctionRange& range)>;

// How far the source was when it had read a chunk.
struct SourceProgress {
  std::uint64_t bytes_read = 0, bytes_total = 0, triangles_read = 0;
};

struct PipelineOptions {
  unsigned threads = 1;
  ChooseSweep choose_sweep = {};  // empty: nothing but the graph
  // Called in order after each chunk was glued; may throw to stop the run.
  std::function<void(const SourceProgress&)> progress = {};
  // Called after that where the run can go on: the place behind the chunk, and how to save what was
  // glued up to there.
  std::function<void(const ChunkPlace&, const SaveEngine&)> between_chunks = {};
  // What an earlier process saved; the source starts at that place.
  StateReader* saved_engine = nullptr;
};

struct PipelineResult {
  LiveMaximum live;
  std::vector<std::uint64_t> removed_pairs;  // as noise, by function
};

// Runs all chunks of `source`; the graph of function i goes to sinks[i], called in stream order
// by one thread at a time. The graph does not depend on threads or chunks, and an embedding or what
// was removed as noise not on threads.
// THROWS: what the source and the sinks throw; DamagedState of saved_engine; Error{kResource} when the budget is too
// small.
PipelineResult run_pipeline(ChunkSource& source, std::span<GraphSink* const> sinks, MemoryBudget& budget,
                            const PipelineOptions& options);

}  // namespace reeb::ooc
