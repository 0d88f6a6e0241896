#include "ooc/stored_graph/last_noise_pass.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "libreeb/base/error.h"
#include "libreeb/graph/packed_lists.h"
#include "libreeb/noise/denoise.h"
#include "ooc/stored_graph/change_builder.h"
#include "ooc/stored_graph/noise_places.h"
#include "ooc/stored_graph/pass_room.h"
#include "ooc/tables/node_table.h"

namespace reeb::ooc {
namespace {

// All arcs of these nodes with their payloads, in the order of the graph. They are counted first, since growing vectors
// would take twice the memory.
RecordBatch<StoredArc> gather(const NoisyGraph& graph, const std::vector<SweepKey>& nodes) {
  const SparseNodeTable table(nodes);
  const auto for_each = [&](const auto& visit) {
    graph.scan_meeting_arcs(table, [&](const StoredArc& arc, const auto& batch) {
      visit(arc, graph.is_embedded() ? batch.payload(arc) : std::span<const std::byte>());
    });
  };
  std::size_t count = 0, payload_bytes = 0;
  for_each([&](const StoredArc&, std::span<const std::byte> payload) {
    ++count;
    payload_bytes += payload.size();
  });
  if (payload_bytes > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::kResource, "the buckets of the arcs from which noise is to be removed take more than 4 GiB",
                "use fewer buckets (--buckets N), or leave out the embedding (--buckets 0)");
  RecordBatch<StoredArc> arcs;
  arcs.records.reserve(count);
  arcs.pool.reserve(payload_bytes);
  for_each([&](const StoredArc& arc, std::span<const std::byte> payload) { arcs.add(arc, payload); });
  std::sort(arcs.records.begin(), arcs.records.end(), SortedArcs::in_order);
  return arcs;
}

// None without an exponent.
PackedLists buckets_of(const RecordBatch<StoredArc>& arcs, std::optional<int> exponent) {
  PackedLists all;
  if (!exponent) return all;
  all.reserve(arcs.records.size());
  std::vector<Bucket> own;
  for (const StoredArc& arc : arcs.records) {
    own.clear();
    decode_buckets_of(arc.keys, arcs.payload(arc), *exponent, own);
    all.add(own);
  }
  return all;
}

ReebGraph graph_of(RecordBatch<StoredArc> arcs) {
  std::vector<std::byte>().swap(arcs.pool);  // before more memory is taken
  std::vector<ArcKeys> keys;
  keys.reserve(arcs.records.size());
  for (const StoredArc& arc : arcs.records) keys.push_back(arc.keys);
  arcs = {};
  return make_graph(std::move(keys), {});
}

// Which nodes of a part are among these. Both ascend, and the part has all of them.
std::vector<bool> mark(const ReebGraph& part, const std::vector<SweepKey>& nodes) {
  std::vector<bool> marked(part.node_count());
  for (std::size_t node = 0, next = 0; next < nodes.size(); ++node)
    if (part.nodes[node] == nodes[next]) marked[node] = true, ++next;
  return marked;
}

// Finds the positions of the wanted nodes of a part: those that can enter a bucket.
void find_positions(const SegmentStore& store, ReebGraph& part, const std::vector<bool>& wanted) {
  part.positions.resize(part.node_count());
  const SparseNodeTable table(part.nodes);
  const auto is_wanted = [&](const SweepKey& key) {
    const std::uint32_t node = table.find(key);
    return node != NodeTable::kNone && wanted[node];
  };
  store.scan_nodes(is_wanted,
                   [&](const SettledNode& stored) { part.positions[table.find(stored.key)] = stored.position; });
}

std::vector<SweepKey> nodes_of_part(const std::vector<SweepKey>& nodes, const std::vector<std::uint32_t>& part_of,
                                    std::uint32_t part) {
  std::vector<SweepKey> own;
  own.reserve(static_cast<std::size_t>(std::count(part_of.begin(), part_of.end(), part)));
  for (std::size_t node = 0; node < nodes.size(); ++node)
    if (part_of[node] == part) own.push_back(nodes[node]);
  return own;
}

// Removes noise at its places, part by part.
class NoiseRemoval {
 public:
  NoiseRemoval(const NoisyGraph& graph, ChangeBuilder& change) : graph_(graph), change_(change) {}

  // Leaves only the nodes of the places.
  void run(NoisePlaces& places);
  std::uint64_t removed_pairs() const { return removed_pairs_; }
  // The bytes that are enough for all of it.
  std::uint64_t enough() const { return enough_; }

 private:
  void remove_in(const std::vector<SweepKey>& nodes, std::uint64_t bytes);

  const NoisyGraph& graph_;
  ChangeBuilder& change_;
  std::uint64_t held_ = 0;  // bytes for the places
  std::uint64_t enough_ = 0;
  std::uint64_t removed_pairs_ = 0;
};

void NoiseRemoval::run(NoisePlaces& places) {
  constexpr std::uint64_t kParts = 16;
  PassRoom& room = graph_.room;
  std::uint64_t all = 0;
  for (std::size_t node = 0; node < places.size(); ++node) all += places.weight(node);
  held_ = NoisePlaces::bytes(places.size()) + sizeof(std::uint32_t) * places.size();
  enough_ = held_ + 2 * all;
  if (!room.make(held_, enough_)) return;
  const std::uint64_t part_bytes =
      std::min(std::max(graph_.options.part_bytes, all / kParts), graph_.store.budget().free_bytes() / 2);
  if (all <= part_bytes) {
    places.keep_nodes();
    return remove_in(places.nodes, all);
  }
  const NoiseParts parts = divide(graph_, places, part_bytes, held_, enough_);
  if (!room.fits()) return;
  places.keep_nodes();
  enough_ = room.bytes() + 2 * std::accumulate(parts.weights.begin(), parts.weights.end(), std::uint64_t{0}) +
            NoisePlaces::bytes(2 * places.size());
  for (std::uint32_t part = 0; part < parts.weights.size() && room.fits(); ++part) {
    const std::vector<SweepKey> nodes = nodes_of_part(places.nodes, parts.part_of, part);
    remove_in(nodes, parts.weights[part] + sizeof(SweepKey) * nodes.size());
  }
}

void NoiseRemoval::remove_in(const std::vector<SweepKey>& nodes, std::uint64_t bytes) {
  if (!graph_.room.make(held_ + bytes, enough_)) return;
  const std::optional<int> exponent = graph_.options.bucket_exponent;
  RecordBatch<StoredArc> arcs = gather(graph_, nodes);
  PackedLists buckets = buckets_of(arcs, exponent);
  change_.count_replaced(arcs.records.size(), buckets);
  ReebGraph part = graph_of(std::move(arcs));
  const std::vector<bool> whole = mark(part, nodes);
  if (exponent) find_positions(graph_.store, part, whole);
  const std::vector<SweepKey> former_nodes = part.nodes;
  const std::vector<NodeId> former_hi = part.hi;
  const Denoised denoised =
      denoise_part(std::move(part), whole, graph_.options.threshold, buckets, exponent.value_or(0));
  removed_pairs_ += denoised.removed.size();
  graph_.room.shrink(held_ + bytes / 2);  // most of it is free again
  change_.add(denoised, buckets, former_nodes, former_hi, nodes, enough_);
}

}  // namespace

LastNoisePass run_last_noise_pass(SegmentStore& store, const io::TempDir& temp, const LastNoiseOptions& options) {
  PassRoom room(store.budget());
  const NoisyGraph graph{store, options, room};
  ChangeBuilder change(store, temp, room, options);
  NoiseRemoval removal(graph, change);
  NoisePlaces places = find_noise_places(graph);
  if (places.size() != 0) removal.run(places);
  LastNoisePass result;
  result.removed_pairs = removal.removed_pairs();
  if (room.fits() && result.removed_pairs != 0) {
    room.shrink(0);
    result.change = change.finish(std::move(places.nodes), removal.enough());
  }
  result.fits = room.fits();
  result.needed_bytes = room.needed_bytes();
  return result;
}

}  // namespace reeb::ooc
