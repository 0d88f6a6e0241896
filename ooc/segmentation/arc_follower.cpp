#include "ooc/segmentation/arc_follower.h"

#include <algorithm>
#include <stdexcept>

#include "libreeb/segmentation/arc_history.h"
#include "libreeb/segmentation/parallel_arcs.h"
#include "ooc/stored_graph/load_graph.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kRecordsAtOnce = 1024;

SortOptions half_of(const FollowOptions& options) {
  return {.allowance_bytes = options.allowance_bytes / 2,
          .most_bytes = options.most_bytes / 2,
          .background = options.background,
          .poll = options.poll};
}

// `from` is the first node that can be the one.
NodeId node_at(const std::vector<SweepKey>& nodes, std::size_t from, const SweepKey& key) {
  const auto found = std::lower_bound(nodes.begin() + static_cast<std::ptrdiff_t>(from), nodes.end(), key);
  if (found == nodes.end() || *found != key) throw std::logic_error("an arc ends in no node");
  return NodeId(static_cast<std::uint32_t>(found - nodes.begin()));
}

}  // namespace

ArcFollower::State::State(const io::TempDir& temp, MemoryBudget& budget, const FollowOptions& options)
    : placed(temp, budget, options.vertex_bound, options.names),
      log(temp, budget, &placed),
      nodes("settled nodes", temp, budget, half_of(options)),
      arcs("settled arcs", temp, budget, half_of(options)) {}

ArcFollower::ArcFollower(const io::TempDir& temp, MemoryBudget& budget, const FollowOptions& options)
    : temp_(temp), budget_(budget), options_(options) {
  start_over();
}

void ArcFollower::start_over() {
  state_.reset();
  state_.emplace(temp_, budget_, options_);
}

void ArcFollower::add_arcs(const SettledArcs& settled) {
  for (const ArcKeys& keys : settled.arcs) {
    const auto number = static_cast<std::uint32_t>(state_->arcs_added++);
    state_->arcs.add({keys}, std::as_bytes(std::span(&number, 1)));
  }
}

FollowedGraph ArcFollower::finish() {
  // Of more arcs, several have the same number; so this comes before any number is used.
  require_numbers(state_->nodes.size(), state_->arcs_added, options_.names.graph,
                  "take a mesh with fewer triangles; arcs of noise are numbered, too");
  if (state_->arcs_added != state_->log.settled()) throw std::logic_error("an arc was settled and not stored");
  FollowedGraph followed = read_graph();
  read_history();
  for (std::size_t n = 0; n < followed.graph.nodes.size(); ++n)
    state_->placed.add_node(followed.graph.nodes[n], static_cast<std::uint32_t>(n));

  const Reservation memory =
      budget_.reserve("order of parallel arcs", ParallelArcs::kArcBytes * followed.graph.arc_count());
  ParallelArcs parallel(followed.graph);
  if (!parallel.any()) return followed;
  std::uint64_t vertex = 0;
  state_->placed.rewind();
  for (auto places = state_->placed.read(); !places.empty(); places = state_->placed.read()) {
    if (options_.poll) options_.poll();
    for (const VertexPlace& place : places) {
      if (place.kind == VertexPlace::Kind::kArc) parallel.see(followed.arc_of_number[place.number], vertex);
      ++vertex;
    }
  }
  const std::vector<ArcId> position = parallel.order();
  for (ArcId& arc : followed.arc_of_number) arc = position[arc.value()];
  return followed;
}

void ArcFollower::read_history() {
  ArcHistory history;
  Reservation charge = budget_.reserve("lists of arcs", 0);
  std::size_t events = 0;
  state_->log.read_backwards([&](const ArcEvent& event) {
    if (events++ % kRecordsAtOnce == 0) {
      charge.resize(history.memory_bytes());
      if (options_.poll) options_.poll();
    }
    const std::uint32_t number = history.undo(event);
    if (event.kind != ArcEvent::Kind::kPlace && event.kind != ArcEvent::Kind::kJoin) return;
    if (number == ArcHistory::kDropped) throw std::logic_error("a vertex lies on an arc that was never settled");
    state_->placed.add_on_arc(event.key, number);
  });
}

FollowedGraph ArcFollower::read_graph() {
  state_->nodes.finish(0, options_.poll);
  state_->arcs.finish(0, options_.poll);
  FollowedGraph followed;
  ReebGraph& graph = followed.graph;
  const auto nodes = static_cast<std::size_t>(state_->nodes.size()),
             arcs = static_cast<std::size_t>(state_->arcs_added);
  followed.memory = budget_.reserve("graph", nodes * sizeof(SweepKey) + arcs * (2 * sizeof(NodeId) + sizeof(ArcId)));
  graph.nodes.reserve(nodes);
  std::vector<SettledNode> some_nodes;
  while (state_->nodes.read(some_nodes, kRecordsAtOnce))
    for (const SettledNode& node : some_nodes) graph.nodes.push_back(node.key);
  graph.lo.reserve(arcs);
  graph.hi.reserve(arcs);
  followed.arc_of_number.resize(arcs);
  RecordBatch<StoredArc> some_arcs;
  std::size_t lo = 0;
  while (state_->arcs.read(some_arcs, kRecordsAtOnce)) {
    for (const StoredArc& arc : some_arcs.records) {
      while (lo < nodes && graph.nodes[lo] < arc.keys.lo) ++lo;
      std::uint32_t number = 0;
      std::ranges::copy(some_arcs.payload(arc), std::as_writable_bytes(std::span(&number, 1)).begin());
      followed.arc_of_number[number] = ArcId(static_cast<std::uint32_t>(graph.arc_count()));
      graph.lo.push_back(node_at(graph.nodes, lo, arc.keys.lo));
      graph.hi.push_back(node_at(graph.nodes, lo, arc.keys.hi));
    }
  }
  return followed;
}

}  // namespace reeb::ooc
