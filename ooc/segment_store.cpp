#include "ooc/segment_store.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "ooc/column_codec.h"

namespace reeb::ooc {

namespace {

std::uint64_t bits(const SweepKey& key) { return ordered_bits(key.value); }
std::uint64_t id(const SweepKey& key) { return key.vertex.value(); }

// A column of what `number` rises by from each record to the next, the first from 0.
template <class Record, class Number>
void add_differences(ColumnEncoder& columns, std::span<const Record> records, const Number& number) {
  columns.add(records.size(), [&](std::size_t i) {
    return zigzag(number(records[i]) - (i == 0 ? 0 : number(records[i - 1])));
  });
}

}  // namespace

void NodeCodec::encode(std::span<const SettledNode> nodes, std::vector<std::byte>& packed) {
  ColumnEncoder columns;
  add_differences(columns, nodes, [](const SettledNode& n) { return bits(n.key); });
  add_differences(columns, nodes, [](const SettledNode& n) { return id(n.key); });
  for (std::size_t k = 0; k < 3; ++k)
    add_differences(columns, nodes, [k](const SettledNode& n) { return ordered_bits(n.position[k]); });
  columns.pack(packed);
}

bool NodeCodec::decode(std::span<const std::byte> packed, std::span<SettledNode> nodes) {
  const ColumnDecoder columns(packed, 5, nodes.size());
  if (!columns.ok()) return false;
  std::array<std::uint64_t, 5> sum{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += unzigzag(columns.at(c, i));
    nodes[i].key = {from_ordered_bits(sum[0]), VertexId(sum[1])};
    for (std::size_t k = 0; k < 3; ++k) nodes[i].position[k] = from_ordered_bits(sum[2 + k]);
  }
  return true;
}

void ArcCodec::encode(std::span<const ArcKeys> arcs, std::vector<std::byte>& packed) {
  ColumnEncoder columns;
  add_differences(columns, arcs, [](const ArcKeys& a) { return bits(a.lo); });
  add_differences(columns, arcs, [](const ArcKeys& a) { return id(a.lo); });
  columns.add(arcs.size(), [&](std::size_t i) { return bits(arcs[i].hi) - bits(arcs[i].lo); });
  columns.add(arcs.size(), [&](std::size_t i) { return zigzag(id(arcs[i].hi) - id(arcs[i].lo)); });
  columns.pack(packed);
}

bool ArcCodec::decode(std::span<const std::byte> packed, std::span<ArcKeys> arcs) {
  const ColumnDecoder columns(packed, 4, arcs.size());
  if (!columns.ok()) return false;
  std::uint64_t lo_bits = 0, lo_id = 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    lo_bits += unzigzag(columns.at(0, i));
    lo_id += unzigzag(columns.at(1, i));
    arcs[i].lo = {from_ordered_bits(lo_bits), VertexId(lo_id)};
    arcs[i].hi = {from_ordered_bits(lo_bits + columns.at(2, i)),
                  VertexId(lo_id + unzigzag(columns.at(3, i)))};
  }
  return true;
}

namespace {

SortOptions half_of(const SegmentOptions& options, const char* suffix) {
  return {.allowance_bytes = options.allowance_bytes / 2,
          .background = options.background,
          .file = options.files.empty() ? "" : options.files + suffix};
}

}  // namespace

SegmentStore::SegmentStore(const TempDir& temp, MemoryBudget& budget, const SegmentOptions& options)
    : budget_(&budget),
      nodes_("settled nodes", temp, budget, half_of(options, ".nodes")),
      arcs_("settled arcs", temp, budget, half_of(options, ".arcs")) {}

void SegmentStore::finish() {
  nodes_.finish();
  arcs_.finish();
}

namespace {

constexpr std::size_t kStretch = 4096;  // records taken over at once

// The node with this key. Searches upward from `from`, in steps that double, since the ends of
// an arc are mostly near each other.
NodeId find_node(const std::vector<SweepKey>& nodes, std::size_t from, const SweepKey& key) {
  std::size_t step = 1;
  while (from + step < nodes.size() && nodes[from + step] < key) step *= 2;
  const auto begin = nodes.begin() + static_cast<std::ptrdiff_t>(std::min(nodes.size(), from + step / 2));
  const auto end = nodes.begin() + static_cast<std::ptrdiff_t>(std::min(nodes.size(), from + step + 1));
  const auto found = std::lower_bound(begin, end, key);
  if (found == end || !(*found == key))
    throw std::logic_error("an arc ends in vertex " + std::to_string(key.vertex.value()) +
                           ", which is no node");
  return NodeId(static_cast<std::uint32_t>(found - nodes.begin()));
}

}  // namespace

LoadedGraph read_graph(SegmentStore& store, bool with_positions) {
  const auto node_count = static_cast<std::size_t>(store.node_count());
  const auto arc_count = static_cast<std::size_t>(store.arc_count());
  LoadedGraph loaded;
  ReebGraph& graph = loaded.graph;
  loaded.memory = store.budget().reserve(
      "graph", node_count * (sizeof(SweepKey) + (with_positions ? sizeof(Point) : 0)) +
                   arc_count * 2 * sizeof(NodeId));
  graph.nodes.reserve(node_count);
  if (with_positions) graph.positions.reserve(node_count);
  store.nodes().rewind();
  for (std::vector<SettledNode> some; store.nodes().read(some, kStretch);)
    for (const SettledNode& node : some) {
      graph.nodes.push_back(node.key);
      if (with_positions) graph.positions.push_back(node.position);
    }
  graph.lo.reserve(arc_count);
  graph.hi.reserve(arc_count);
  store.arcs().rewind();
  std::size_t lo = 0;
  for (std::vector<ArcKeys> some; store.arcs().read(some, kStretch);)
    for (const ArcKeys& arc : some) {
      lo = find_node(graph.nodes, lo, arc.lo).value();
      graph.lo.emplace_back(static_cast<std::uint32_t>(lo));
      graph.hi.push_back(find_node(graph.nodes, lo, arc.hi));
    }
  return loaded;
}

}  // namespace reeb::ooc
