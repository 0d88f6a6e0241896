// Follows the vertices of a run to the arcs of its graph (docs/ARCHITECTURE.md, Which arc a vertex lies on).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/graph_sink.h"
#include "ooc/segmentation/event_log.h"
#include "ooc/segmentation/placed_vertices.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

struct FollowOptions {
  std::uint64_t vertex_bound = 0;           // all vertices of the mesh are below
  PlacedNames names = {};                   // of a vertex that is not
  std::uint64_t allowance_bytes = 1 << 20;  // for sorting settled nodes and arcs
  std::uint64_t most_bytes = 0;             // limit to which it grows if there are many
  bool background = true;                   // sort in separate threads
  std::function<void()> poll = {};          // called often; may throw to stop
};

// A graph of which every vertex was followed.
struct FollowedGraph {
  ReebGraph graph;  // without positions
  // By the number that an arc got when it was settled: its position in the graph (parallel_arcs.h).
  std::vector<ArcId> arc_of_number;
  Reservation memory;
};

// The sink and the log of a run. Afterwards finish() gives every vertex a place, with the numbers of a FollowedGraph.
//
// THROWS: Error{kResource} of the budget or the disk.   THREADS: one at a time.
class ArcFollower : public GraphSink {
 public:
  // Both must outlive this.
  ArcFollower(const io::TempDir& temp, MemoryBudget& budget, const FollowOptions& options);

  // Forgets everything.
  void start_over();
  ArcLog& log() { return state_->log; }
  void add_nodes(std::span<const SettledNode> nodes) override { state_->nodes.add(nodes); }
  void add_arcs(const SettledArcs& settled) override;

  // Gives every vertex a place: the number of its arc when it was settled, or the position of its node in the graph.
  // REQUIRES: the run is over.   THROWS: also what require_numbers() does.
  FollowedGraph finish();
  PlacedVertices& places() { return state_->placed; }

 private:
  struct State {
    State(const io::TempDir& temp, MemoryBudget& budget, const FollowOptions& options);
    PlacedVertices placed;
    EventLog log;
    SortedNodes nodes;
    SortedArcs arcs;
    std::uint64_t arcs_added = 0;
  };

  void read_history();
  FollowedGraph read_graph();

  const io::TempDir& temp_;
  MemoryBudget& budget_;
  const FollowOptions options_;
  std::optional<State> state_;
};

}  // namespace reeb::ooc
