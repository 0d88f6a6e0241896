#include "ooc/stored_graph/noise_places.h"

#include <algorithm>

#include "libreeb/containers/growing_array.h"
#include "libreeb/containers/union_find.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/noise/noise_scope.h"
#include "ooc/stored_graph/arc_payload.h"

namespace reeb::ooc {
namespace {

// Memory to remove leaves in a part of the graph: per node; per arc with two ends in the part, and with one; and per
// byte of packed buckets, and per unpacked bucket.
constexpr std::uint64_t kNodeBytes = 80, kInnerArcBytes = 64, kArcBytes = kInnerArcBytes + kNodeBytes;
constexpr std::uint64_t kPackedByte = 1, kBucketBytes = 58;

// Memory to find the scope in a graph of short arcs: the graph, the degrees of its nodes and the size of their buckets,
// and either the table that finds nodes or what noise_scope() takes.
std::uint64_t search_bytes(std::uint64_t arcs, std::uint64_t nodes) {
  constexpr std::uint64_t kNode = sizeof(SweepKey) + 16, kArc = 2 * sizeof(NodeId), kScopeNode = 25, kScopeArc = 12;
  return kNode * nodes + kArc * arcs + std::max(SparseNodeTable::bytes(nodes), kScopeNode * nodes + kScopeArc * arcs);
}

// Memory to make that graph from this many arcs, while there is room for `held` arcs.
std::uint64_t short_graph_bytes(std::uint64_t arcs, std::uint64_t held) {
  return sizeof(ArcKeys) * held + (4 * sizeof(SweepKey) + 2 * sizeof(NodeId)) * arcs;
}

// Memory is reserved for a quarter more arcs at a time, so that little of it is unused.
std::size_t next_room(std::size_t arcs) { return std::max<std::size_t>(1024, arcs + arcs / 4); }

// The memory for removing noise if all of the graph is touched, including the change.
std::uint64_t most_bytes(const NoisyGraph& graph) {
  const SegmentStore& store = graph.store;
  const std::uint64_t of_buckets =
      graph.is_embedded() ? kPackedByte * store.payload_bytes() + kBucketBytes * store.bucket_count() : 0;
  constexpr std::uint64_t kGoneNode = 2 * sizeof(SweepKey) + 20, kMergedBlocks = 6;
  const std::uint64_t of_change = kGoneNode * store.node_count() + kMergedBlocks * kRunBlockBytes +
                                  (graph.is_embedded() ? store.payload_bytes() : 0);
  return kNodeBytes * store.node_count() + kInnerArcBytes * store.arc_count() + of_buckets + of_change;
}

// Worthwhile if the graph is not small compared with the mesh.
void note_ends(const NoisyGraph& graph) {
  const std::uint64_t vertices = graph.options.vertices, bytes = ArcEnds::bytes(vertices),
                      few = sizeof(ArcKeys) / 8 * graph.store.arc_count();
  if (vertices != 0 && bytes <= few && graph.room.try_spare(bytes)) graph.room.ends.emplace(vertices);
}

// Short arcs that end in an extremum, plus those connected to them; or all short arcs if that takes too long to tell.
std::vector<ArcKeys> find_short_arcs(const NoisyGraph& graph) {
  PassRoom& room = graph.room;
  GrowingArray<ArcKeys> found;
  std::uint64_t count = 0;
  std::size_t has_room = 0;  // arcs
  note_ends(graph);
  graph.store.scan_arc_keys([&](const ArcKeys& arc) {
    if (room.ends) room.ends->add(arc);
    if (!is_short(arc.lo.value, arc.hi.value, graph.options.threshold)) return;
    if (count++ == has_room) {
      has_room = next_room(has_room);
      room.make(sizeof(ArcKeys) * has_room, 0);
    }
    if (!room.fits()) return;
    found.append(arc);
  });
  if (room.fits()) room.make(2 * sizeof(ArcKeys) * count, 0);
  if (room.fits()) {
    std::vector<ArcKeys> kept = room.ends ? room.ends->connected_to_extrema(found.all())
                                          : std::vector<ArcKeys>(found.all().begin(), found.all().end());
    found = {};
    room.make(short_graph_bytes(kept.size(), kept.size()), 0);
    if (room.fits()) return kept;
  }
  room.refuse(short_graph_bytes(count, 2 * count + next_room(0)) + search_bytes(count, 2 * count) + most_bytes(graph));
  return {};
}

// Vectors that grow take up to three times their content.
void keep_arc(const NoisyGraph& graph, const StoredArc& arc, std::span<const std::byte> payload) {
  auto& kept = graph.room.kept_arcs;
  if (!kept) return;
  if (kept->bytes() + sizeof(arc) + payload.size() <= graph.options.part_bytes / 3)
    kept->add(arc, payload);
  else
    graph.room.release_spare();
}

// The ends of short arcs, as they are in the whole graph.
struct ShortArcEnds {
  explicit ShortArcEnds(std::size_t nodes)
      : degrees{std::vector<std::uint32_t>(nodes), std::vector<std::uint32_t>(nodes)}, bucket_bytes(nodes) {}

  Degrees degrees;
  std::vector<std::uint64_t> bucket_bytes;  // memory for the buckets of all arcs of a node
};

// Keeps the arcs of these nodes if they are few.
ShortArcEnds look_at_ends(const NoisyGraph& graph, const ReebGraph& short_arcs) {
  ShortArcEnds ends(short_arcs.node_count());
  const SparseNodeTable table(short_arcs.nodes);
  if (graph.room.try_spare(graph.options.part_bytes)) graph.room.kept_arcs.emplace();
  graph.store.scan_arcs(meets(table), [&](const StoredArc& arc, const auto& batch) {
    const std::uint32_t lo = table.find(arc.keys.lo), hi = table.find(arc.keys.hi);
    const std::span<const std::byte> payload = batch.payload(arc);
    const std::uint64_t bytes = graph.bucket_bytes(payload);
    if (lo != NodeTable::kNone) ++ends.degrees.up[lo], ends.bucket_bytes[lo] += bytes;
    if (hi != NodeTable::kNone) ++ends.degrees.down[hi], ends.bucket_bytes[hi] += bytes;
    keep_arc(graph, arc, payload);
  });
  return ends;
}

// An arc between two of the nodes was counted at both.
void join_neighbours(const NoisyGraph& graph, const std::vector<SweepKey>& nodes, UnionFind& joined,
                     std::vector<std::uint64_t>& weights) {
  const SparseNodeTable table(nodes);
  graph.scan_meeting_arcs(table, [&](const StoredArc& arc, const auto& batch) {
    const std::uint32_t lo = table.find(arc.keys.lo), hi = table.find(arc.keys.hi);
    if (lo == NodeTable::kNone || hi == NodeTable::kNone) return;
    joined.unite(lo, hi);
    weights[lo] -= kArcBytes + graph.bucket_bytes(batch.payload(arc));
    weights[hi] -= kArcBytes - kInnerArcBytes;
  });
}

}  // namespace

std::uint64_t NoisePlaces::weight(std::size_t node) const {
  return kNodeBytes + kArcBytes * arcs[node] + bucket_bytes[node];
}

std::uint64_t NoisyGraph::bucket_bytes(std::span<const std::byte> payload) const {
  return is_embedded() ? kPackedByte * payload.size() + kBucketBytes * bucket_count(payload) : 0;
}

NoisePlaces find_noise_places(const NoisyGraph& graph) {
  PassRoom& room = graph.room;
  std::vector<ArcKeys> found = find_short_arcs(graph);
  room.release_spare();
  if (found.empty()) return {};
  const ReebGraph short_arcs = make_graph(std::move(found), {});
  const std::uint64_t bytes = search_bytes(short_arcs.arc_count(), short_arcs.node_count());
  const std::uint64_t enough = bytes + most_bytes(graph);
  if (!room.make(bytes, enough)) return {};
  const ShortArcEnds ends = look_at_ends(graph, short_arcs);
  const std::vector<bool> in_scope = noise_scope(short_arcs, ends.degrees);
  const auto size = static_cast<std::size_t>(std::count(in_scope.begin(), in_scope.end(), true));
  if (!room.make(bytes + NoisePlaces::bytes(size), enough)) return {};
  NoisePlaces places;
  places.nodes.reserve(size);
  places.arcs.reserve(size);
  places.bucket_bytes.reserve(size);
  for (std::size_t node = 0; node < in_scope.size(); ++node) {
    if (!in_scope[node]) continue;
    places.nodes.push_back(short_arcs.nodes[node]);
    places.arcs.push_back(ends.degrees.down[node] + ends.degrees.up[node]);
    places.bucket_bytes.push_back(ends.bucket_bytes[node]);
  }
  return places;
}

NoiseParts divide(const NoisyGraph& graph, const NoisePlaces& places, std::uint64_t part_bytes, std::uint64_t held,
                  std::uint64_t enough) {
  const auto count = static_cast<std::uint32_t>(places.size());
  if (!graph.room.make(held + SparseNodeTable::bytes(count) + 20ull * count, enough)) return {};
  UnionFind joined(count);
  std::vector<std::uint64_t> weights(count);
  for (std::uint32_t node = 0; node < count; ++node) weights[node] = places.weight(node);
  join_neighbours(graph, places.nodes, joined, weights);
  for (std::uint32_t node = 0; node < count; ++node)
    if (joined.find(node) != node) weights[joined.find(node)] += weights[node];
  NoiseParts parts{std::vector<std::uint32_t>(count), {}};
  for (std::uint32_t node = 0; node < count; ++node) {
    if (joined.find(node) != node) continue;
    if (parts.weights.empty() || parts.weights.back() + weights[node] > part_bytes) parts.weights.push_back(0);
    parts.weights.back() += weights[node];
    parts.part_of[node] = static_cast<std::uint32_t>(parts.weights.size() - 1);
  }
  for (std::uint32_t node = 0; node < count; ++node) parts.part_of[node] = parts.part_of[joined.find(node)];
  return parts;
}

}  // namespace reeb::ooc
