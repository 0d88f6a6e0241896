#include "ooc/segment_store.h"

#include <algorithm>
#include <bit>
#include <future>
#include <stdexcept>
#include <string>

#include "ooc/arc_payload.h"
#include "ooc/column_codec.h"
#include "ooc/read_ahead.h"

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

// Calls sum(i, s) with the sum s of the first i + 1 differences.
template <class Sum>
void for_sums(std::span<const std::uint64_t> differences, const Sum& sum) {
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < differences.size(); ++i) sum(i, total += unzigzag(differences[i]));
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
  ColumnDecoder columns(packed, 5, nodes.size());
  if (!columns.ok() || !columns.tail().empty()) return false;
  for_sums(columns.column(0), [&](std::size_t i, std::uint64_t sum) { nodes[i].key.value = from_ordered_bits(sum); });
  for_sums(columns.column(1), [&](std::size_t i, std::uint64_t sum) { nodes[i].key.vertex = VertexId(sum); });
  for (std::size_t k = 0; k < 3; ++k)
    for_sums(columns.column(2 + k), [&](std::size_t i, std::uint64_t sum) { nodes[i].position[k] = from_ordered_bits(sum); });
  return true;
}

namespace {

// Sorting has left the payloads anywhere in the pool.
void add_payloads(std::span<const StoredArc> arcs, std::span<const std::byte> pool, std::vector<std::byte>& packed) {
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (i + kAhead < arcs.size()) __builtin_prefetch(pool.data() + arcs[i + kAhead].payload.first);
    const auto payload = pool.subspan(arcs[i].payload.first, arcs[i].payload.size);
    if (!payload.empty()) packed.insert(packed.end(), payload.begin(), payload.end());
  }
}

}  // namespace

void ArcCodec::encode(std::span<const StoredArc> arcs, std::span<const std::byte> pool,
                      std::vector<std::byte>& packed) {
  ColumnEncoder columns;
  add_differences(columns, arcs, [](const StoredArc& a) { return bits(a.keys.lo); });
  add_differences(columns, arcs, [](const StoredArc& a) { return id(a.keys.lo); });
  columns.add(arcs.size(), [&](std::size_t i) { return bits(arcs[i].keys.hi) - bits(arcs[i].keys.lo); });
  columns.add(arcs.size(), [&](std::size_t i) { return zigzag(id(arcs[i].keys.hi) - id(arcs[i].keys.lo)); });
  columns.add(arcs.size(), [&](std::size_t i) { return arcs[i].payload.size; });
  columns.pack(packed);
  add_payloads(arcs, pool, packed);
}

bool ArcCodec::decode(std::span<const std::byte> packed, std::span<StoredArc> arcs,
                      std::vector<std::byte>& pool) {
  ColumnDecoder columns(packed, 5, arcs.size());
  if (!columns.ok()) return false;
  for_sums(columns.column(0), [&](std::size_t i, std::uint64_t sum) { arcs[i].keys.lo.value = from_ordered_bits(sum); });
  for_sums(columns.column(1), [&](std::size_t i, std::uint64_t sum) { arcs[i].keys.lo.vertex = VertexId(sum); });
  auto column = columns.column(2);
  for (std::size_t i = 0; i < arcs.size(); ++i)
    arcs[i].keys.hi.value = from_ordered_bits(bits(arcs[i].keys.lo) + column[i]);
  column = columns.column(3);
  for (std::size_t i = 0; i < arcs.size(); ++i)
    arcs[i].keys.hi.vertex = VertexId(id(arcs[i].keys.lo) + unzigzag(column[i]));
  column = columns.column(4);
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < arcs.size(); first += column[i++])
    arcs[i].payload = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(column[i])};
  pool.assign(columns.tail().begin(), columns.tail().end());
  return first == pool.size();
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
      background_(options.background),
      nodes_("settled nodes", temp, budget, half_of(options, ".nodes")),
      arcs_("settled arcs", temp, budget, half_of(options, ".arcs")) {}

void SegmentStore::add_arcs(const SettledArcs& settled) {
  if (settled.bucket_counts.empty()) {
    plain_.clear();
    for (const ArcKeys& arc : settled.arcs) plain_.push_back({arc});
    arcs_.add(plain_);
    return;
  }
  std::size_t first = 0;
  for (std::size_t i = 0; i < settled.arcs.size(); first += settled.bucket_counts[i++]) {
    payload_.clear();
    encode_buckets(settled.buckets.subspan(first, settled.bucket_counts[i]), settled.bucket_exponent, payload_);
    arcs_.add({settled.arcs[i]}, payload_);
  }
  bucket_count_ += first;
}

void SegmentStore::save(StateWriter& out) {
  out.put(bucket_count_);
  nodes_.save(out);
  arcs_.save(out);
}

void SegmentStore::restore(StateReader& in) {
  in.get(bucket_count_);
  nodes_.restore(in);
  arcs_.restore(in);
}

void SegmentStore::finish() {
  constexpr std::uint64_t kMost = 64 << 20;  // a thousand runs
  const std::uint64_t merge_bytes = std::min(budget_->free_bytes() / 8, kMost);
  std::future<void> nodes;
  if (background_) nodes = std::async(std::launch::async, [&] { nodes_.finish(merge_bytes); });
  arcs_.finish(merge_bytes);
  if (background_)
    nodes.get();
  else
    nodes_.finish(merge_bytes);
}

bool SegmentStore::read_arcs(ArcPiece& piece, std::size_t limit, std::optional<int> bucket_exponent) {
  constexpr std::size_t kPayloads = 256 << 10;
  arcs_.read(batch_, limit, kPayloads);
  piece.arcs.clear();
  for (const StoredArc& arc : batch_.records) piece.arcs.push_back(arc.keys);
  if (!bucket_exponent) return !batch_.empty();
  piece.buckets.buckets.clear();
  piece.buckets.offsets.assign(1, 0);
  for (const StoredArc& arc : batch_.records) {
    if (!decode_buckets(batch_.payload(arc), *bucket_exponent, piece.buckets.buckets))
      throw std::logic_error("the buckets of an arc from vertex " + std::to_string(arc.keys.lo.vertex.value()) +
                             " are no buckets of exponent " + std::to_string(*bucket_exponent));
    piece.buckets.offsets.push_back(piece.buckets.buckets.size());
  }
  return !batch_.empty();
}

namespace {

constexpr std::size_t kStretch = 16384;  // records taken over at once

// From vertices to nodes: a table with linear probing, at most half full.
//
// An arc's upper end may be anywhere, and where values are random it mostly is: a look-up costs two
// places in memory, and those of successive arcs are fetched side by side, which a binary search
// would not allow. MEMORY: 8 to 16 bytes a node.
class NodeTable {
 public:
  explicit NodeTable(const std::vector<SweepKey>& nodes)
      : nodes_(nodes), slots_(std::bit_ceil(2 * nodes.size() + 1), kFree) {
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
      std::size_t slot = home(nodes[node]);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = node;
    }
  }

  static std::uint64_t bytes(std::uint64_t nodes) { return std::bit_ceil(2 * nodes + 1) * sizeof(std::uint32_t); }

  NodeId find(const SweepKey& key) const {
    for (std::size_t slot = home(key); slots_[slot] != kFree; slot = (slot + 1) & (slots_.size() - 1))
      if (nodes_[slots_[slot]] == key) return NodeId(slots_[slot]);
    throw std::logic_error("an arc ends in vertex " + std::to_string(key.vertex.value()) + ", which is no node");
  }

 private:
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};

  std::size_t home(const SweepKey& key) const {
    return static_cast<std::size_t>(key.vertex.value() * 0x9e3779b97f4a7c15u >> 20) & (slots_.size() - 1);
  }

  const std::vector<SweepKey>& nodes_;
  std::vector<std::uint32_t> slots_;
};

// The buckets of the next arcs.
void append(const ArcBuckets& piece, ArcBuckets& all) {
  const std::uint64_t before = all.buckets.size();
  for (std::size_t i = 1; i < piece.offsets.size(); ++i) all.offsets.push_back(before + piece.offsets[i]);
  all.buckets.insert(all.buckets.end(), piece.buckets.begin(), piece.buckets.end());
}

std::uint64_t graph_bytes(const SegmentStore& store, const LoadOptions& options) {
  const std::uint64_t nodes = store.node_count(), arcs = store.arc_count();
  std::uint64_t bytes = nodes * sizeof(SweepKey) + arcs * 2 * sizeof(NodeId);
  if (options.positions) bytes += nodes * sizeof(Point);
  if (options.bucket_exponent) bytes += (arcs + 1) * sizeof(std::uint64_t) + store.bucket_count() * sizeof(Bucket);
  return bytes;
}

}  // namespace

std::uint64_t loading_bytes(const SegmentStore& store, const LoadOptions& options) {
  return graph_bytes(store, options) + NodeTable::bytes(store.node_count());
}

LoadedGraph read_graph(SegmentStore& store, const LoadOptions& options) {
  const auto node_count = static_cast<std::size_t>(store.node_count());
  const auto arc_count = static_cast<std::size_t>(store.arc_count());
  const auto bucket_count = static_cast<std::size_t>(options.bucket_exponent ? store.bucket_count() : 0);
  LoadedGraph loaded;
  ReebGraph& graph = loaded.graph;
  loaded.memory = store.budget().reserve("graph", graph_bytes(store, options));
  graph.nodes.reserve(node_count);
  if (options.positions) graph.positions.reserve(node_count);
  store.nodes().rewind();
  for (std::vector<SettledNode> some; store.nodes().read(some, kStretch);)
    for (const SettledNode& node : some) {
      graph.nodes.push_back(node.key);
      if (options.positions) graph.positions.push_back(node.position);
    }
  graph.lo.reserve(arc_count);
  graph.hi.reserve(arc_count);
  if (options.bucket_exponent) {
    loaded.buckets.offsets.reserve(arc_count + 1);
    loaded.buckets.offsets.push_back(0);
    loaded.buckets.buckets.reserve(bucket_count);
  }
  const Reservation table_memory = store.budget().reserve("ends of arcs", NodeTable::bytes(node_count));
  const NodeTable table(graph.nodes);
  store.rewind_arcs();
  read_ahead<ArcPiece>(
      store.background(),
      [&](ArcPiece& piece) { return store.read_arcs(piece, kStretch, options.bucket_exponent); },
      [&](const ArcPiece& piece) {
        for (const ArcKeys& arc : piece.arcs) {
          graph.lo.push_back(table.find(arc.lo));
          graph.hi.push_back(table.find(arc.hi));
        }
        append(piece.buckets, loaded.buckets);
      });
  return loaded;
}

}  // namespace reeb::ooc
