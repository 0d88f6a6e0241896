// The graph of a run as it was stored, without pairs and levels, and its file.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "libreeb/base/error.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/sweep/sweep_options.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "ooc/run/run_context.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

// A finished store and how to write it.
struct StoredGraph {
  std::unique_ptr<SegmentStore> store;
  std::string output;
  SweepOptions sweep;
  FileMeta meta;
  std::uint64_t vertex_bound;  // more than the index of any vertex
};

struct WrittenGraph {
  BettiNumbers betti;
  std::uint64_t spilled_bytes = 0;
};

// Tells the progress of the second stage.
Poll stage_poll(const RunContext& run);

// Writes the graph as it was stored; the memory need not grow with the graph. If there is memory to spare, it uses 4
// bytes per node, and 4 bytes per vertex if there are many look-ups.
WrittenGraph write_graph(RunContext& run, const StoredGraph& graph, const FileMeta& meta);

// What a step needs: `most` suffices, and with less than `least` there is no use in trying.
struct NeededBytes {
  std::uint64_t least, most;
};
// The error for a graph that was written although its next step did not fit.
Error no_memory_for(const RunContext& run, const std::string& what, const std::string& output, std::uint64_t arcs,
                    NeededBytes needed, const std::string& otherwise);

}  // namespace reeb::ooc
