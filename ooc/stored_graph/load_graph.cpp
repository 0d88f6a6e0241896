#include "ooc/stored_graph/load_graph.h"

#include <string>
#include <vector>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "ooc/tables/node_table.h"
#include "ooc/threads/read_ahead.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kRecordsAtOnce = 4096;

NodeId node_of(const SweepKey& key, const NodeTable& table) {
  const std::uint32_t node = table.find(key);
  if (node == NodeTable::kNone)
    throw BrokenGraph("an arc ends in vertex " + std::to_string(key.vertex.value()) + ", which is not a node");
  return NodeId(node);
}

// The ends of arcs as nodes. Arcs come by lower end, so each is found soon after the one before.
void find_ends(std::span<const ArcKeys> arcs, const std::vector<SweepKey>& nodes, const NodeTable& table,
               std::vector<NodeId>& lo, std::vector<NodeId>& hi) {
  constexpr std::size_t kAhead = 16;  // from one stage of fetching an upper end to the next
  lo.clear();
  hi.clear();
  std::size_t last = arcs.empty() ? 0 : node_of(arcs[0].lo, table).value();
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (i + 2 * kAhead < arcs.size()) table.prefetch_slot(arcs[i + 2 * kAhead].hi);
    if (i + kAhead < arcs.size()) table.prefetch_node(arcs[i + kAhead].hi);
    const auto& [low, high] = arcs[i];
    while (last < nodes.size() && nodes[last] < low) ++last;
    const bool is_node = last < nodes.size() && nodes[last] == low;
    lo.push_back(is_node ? NodeId(static_cast<std::uint32_t>(last)) : node_of(low, table));
    hi.push_back(node_of(high, table));
  }
}

std::uint64_t graph_bytes(const SegmentStore& store, const LoadOptions& options) {
  const std::uint64_t nodes = store.node_count(), arcs = store.arc_count();
  std::uint64_t bytes = nodes * sizeof(SweepKey) + arcs * 2 * sizeof(NodeId);
  if (options.positions) bytes += nodes * sizeof(Point);
  if (options.bucket_exponent) bytes += PackedLists::most_bytes(arcs, store.bucket_count());
  return bytes;
}

}  // namespace

void require_numbers(std::uint64_t nodes, std::uint64_t arcs, const std::string& file, const std::string& hint) {
  constexpr std::uint64_t kMost = ~std::uint32_t{0};
  if (nodes <= kMost && arcs <= kMost) return;
  throw Error(ErrorKind::kResource,
              "the graph has " + count_of(nodes, "node") + " and " + count_of(arcs, "arc") +
                  ", but at most 2^32 - 1 of each can be numbered",
              hint)
      .at(file);
}

std::uint64_t loading_bytes(const SegmentStore& store, const LoadOptions& options) {
  return graph_bytes(store, options) + NodeTable::bytes(store.node_count());
}

LoadedGraph read_graph(SegmentStore& store, const LoadOptions& options, const Poll& poll) {
  const auto node_count = static_cast<std::size_t>(store.node_count());
  const auto arc_count = static_cast<std::size_t>(store.arc_count());
  const double records = static_cast<double>(node_count + arc_count);
  LoadedGraph loaded;
  ReebGraph& graph = loaded.graph;
  const auto tell = [&] {
    if (poll) poll(static_cast<double>(graph.nodes.size() + graph.hi.size()) / records);
  };
  loaded.memory = store.budget().reserve("graph", graph_bytes(store, options));
  graph.nodes.reserve(node_count);
  if (options.positions) graph.positions.reserve(node_count);
  const Reservation table_memory = store.budget().reserve("ends of arcs", NodeTable::bytes(node_count));
  NodeTable table(graph.nodes, node_count);
  store.rewind_nodes();
  using Nodes = std::vector<SettledNode>;
  read_ahead<Nodes>(
      store.background(), [&](Nodes& some) { return store.read_nodes(some, kRecordsAtOnce); },
      [&](const Nodes& some) {
        for (const SettledNode& node : some) {
          graph.nodes.push_back(node.key);
          if (options.positions) graph.positions.push_back(node.position);
        }
        table.add_new();
        tell();
      });
  graph.lo.reserve(arc_count);
  graph.hi.reserve(arc_count);
  if (options.bucket_exponent) loaded.buckets.reserve(arc_count);
  store.rewind_arcs();
  struct Piece {
    ArcPiece stored;
    std::vector<NodeId> lo, hi;
  };
  read_ahead<Piece>(
      store.background(),
      [&](Piece& piece) { return store.read_arcs(piece.stored, kRecordsAtOnce, options.bucket_exponent); },
      [&](Piece& piece) { find_ends(piece.stored.arcs, graph.nodes, table, piece.lo, piece.hi); },
      [&](const Piece& piece) {
        graph.lo.insert(graph.lo.end(), piece.lo.begin(), piece.lo.end());
        graph.hi.insert(graph.hi.end(), piece.hi.begin(), piece.hi.end());
        if (options.bucket_exponent)
          for (std::size_t i = 0; i < piece.lo.size(); ++i) loaded.buckets.add_packed(piece.stored.lists.view().of(i));
        tell();
      });
  if (options.bucket_exponent)
    loaded.memory.resize(loaded.memory.bytes() - PackedLists::most_bytes(arc_count, store.bucket_count()) +
                         loaded.buckets.memory_bytes());
  return loaded;
}

}  // namespace reeb::ooc
