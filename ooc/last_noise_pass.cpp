#include "ooc/last_noise_pass.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "libreeb/hierarchy/denoise.h"
#include "libreeb/hierarchy/noise_scope.h"
#include "ooc/arc_payload.h"
#include "ooc/node_table.h"

namespace reeb::ooc {
namespace {

// How much there is of what noise removal can look at.
struct ScopeSize {
  std::uint64_t arcs = 0, nodes = 0, payload_bytes = 0, buckets = 0;
};

// To gather arcs with their payloads, to make a graph of them and its buckets, and to remove leaves.
std::uint64_t scope_bytes(const ScopeSize& size) {
  constexpr std::uint64_t kArc = 160, kNode = 76, kPayloadByte = 3, kBucket = 128;
  const std::uint64_t nodes = size.nodes + size.arcs;  // with those at the other ends
  return kArc * size.arcs + kNode * nodes + SparseNodeTable::bytes(nodes) + kPayloadByte * size.payload_bytes +
         kBucket * size.buckets;
}

// To make a graph of short arcs that lie in a vector of this capacity.
std::uint64_t short_graph_bytes(std::uint64_t arcs, std::uint64_t capacity) {
  return sizeof(ArcKeys) * capacity + (4 * sizeof(SweepKey) + 2 * sizeof(NodeId)) * arcs;
}

// To find the scope in that graph.
std::uint64_t search_bytes(const ReebGraph& graph) {
  constexpr std::uint64_t kArc = 2 * sizeof(NodeId) + 24, kNode = sizeof(SweepKey) + 8 + 25;
  return kArc * graph.arc_count() + kNode * graph.node_count() + SparseNodeTable::bytes(graph.node_count());
}

class Pass {
 public:
  Pass(SegmentStore& store, double threshold, std::optional<int> exponent)
      : store_(store),
        threshold_(threshold),
        exponent_(exponent),
        memory_(store.budget().reserve("last pass of noise removal", 0)) {}

  LastNoisePass run() {
    find_scope();
    if (result_.fits && !scope_.empty()) gather_scope();
    if (result_.fits && !scope_.empty()) remove_noise();
    return std::move(result_);
  }

 private:
  // Whether there is room; if not, all else only finds out how much would be enough.
  bool make_room(std::uint64_t bytes) {
    result_.fits = result_.fits && memory_.try_resize(bytes);
    return result_.fits;
  }

  void find_scope() {
    const ReebGraph short_arcs = find_short_arcs();
    if (!result_.fits || short_arcs.arc_count() == 0) return;
    if (!make_room(search_bytes(short_arcs))) {
      result_.needed_bytes = search_bytes(short_arcs) + most_scope_bytes();
      return;
    }
    const Degrees degrees = count_degrees(short_arcs);
    const std::vector<bool> in_scope = noise_scope(short_arcs, degrees);
    for (std::size_t node = 0; node < in_scope.size(); ++node) {
      if (!in_scope[node]) continue;
      scope_.push_back(short_arcs.nodes[node]);
      size_.arcs += degrees.down[node] + degrees.up[node];
    }
    size_.nodes = scope_.size();
  }

  ReebGraph find_short_arcs() {
    std::vector<ArcKeys> found;
    std::uint64_t count = 0;
    store_.scan_arcs([&](const StoredArc& arc, const auto&) {
      if (!is_short(arc.keys.lo.value, arc.keys.hi.value, threshold_)) return;
      ++count;
      if (grow(found)) found.push_back(arc.keys);
    });
    if (make_room(short_graph_bytes(count, found.capacity()))) return make_graph(std::move(found), {});
    result_.needed_bytes = short_graph_bytes(count, 2 * count) + most_scope_bytes();
    return {};
  }

  // Whether there is room for one more.
  bool grow(std::vector<ArcKeys>& arcs) {
    constexpr std::size_t kFirst = 1024;
    if (arcs.size() < arcs.capacity()) return true;
    const std::size_t before = arcs.capacity(), after = std::max(kFirst, 2 * before);
    if (make_room((before + after) * sizeof(ArcKeys)))
      arcs.reserve(after);
    else
      std::vector<ArcKeys>().swap(arcs);
    return result_.fits;
  }

  // If all arcs are in the scope.
  std::uint64_t most_scope_bytes() const {
    constexpr std::uint64_t kBucket = 48;  // at most, as payload
    const std::uint64_t buckets = exponent_ ? store_.bucket_count() : 0;
    return scope_bytes({store_.arc_count(), store_.node_count(), kBucket * buckets, buckets});
  }

  Degrees count_degrees(const ReebGraph& graph) const {
    const SparseNodeTable table(graph.nodes);
    Degrees degrees{std::vector<std::uint32_t>(graph.node_count()), std::vector<std::uint32_t>(graph.node_count())};
    store_.scan_arcs([&](const StoredArc& arc, const auto&) {
      if (const std::uint32_t node = table.find(arc.keys.lo); node != NodeTable::kNone) ++degrees.up[node];
      if (const std::uint32_t node = table.find(arc.keys.hi); node != NodeTable::kNone) ++degrees.down[node];
    });
    return degrees;
  }

  // All arcs of the scope with their payloads, in the order of the graph.
  void gather_scope() {
    if (make_room(scope_bytes(size_))) arcs_.records.reserve(static_cast<std::size_t>(size_.arcs));
    const SparseNodeTable table(scope_);
    std::vector<Bucket> buckets;
    size_.arcs = 0;
    store_.scan_arcs([&](const StoredArc& arc, const auto& batch) {
      if (table.find(arc.keys.lo) == NodeTable::kNone && table.find(arc.keys.hi) == NodeTable::kNone) return;
      const auto payload = exponent_ ? batch.payload(arc) : std::span<const std::byte>();
      ++size_.arcs;
      if (exponent_) {
        buckets.clear();
        decode_buckets_of(arc, payload, *exponent_, buckets);
        size_.payload_bytes += payload.size();
        size_.buckets += buckets.size();
      }
      gather(arc, payload);
    });
    if (!result_.fits) result_.needed_bytes = scope_bytes(size_);
    std::sort(arcs_.records.begin(), arcs_.records.end(), SortedArcs::in_order);
  }

  void gather(const StoredArc& arc, std::span<const std::byte> payload) {
    constexpr std::uint64_t kPool = std::numeric_limits<std::uint32_t>::max();
    if (!result_.fits) return;
    const std::uint64_t needed = scope_bytes(size_);
    if (size_.payload_bytes > kPool || (needed > memory_.bytes() && !make_room(needed + needed / 8))) {
      result_.fits = false;
      arcs_ = {};
      return;
    }
    arcs_.add(arc, payload);
  }

  void remove_noise() {
    GraphPatch patch;
    patch.replaced_arcs = size_.arcs;
    patch.replaced_buckets = size_.buckets;
    patch.buckets = scope_buckets();
    ReebGraph part = scope_graph();
    std::vector<bool> whole(part.node_count());
    for (std::size_t node = 0, next = 0; node < whole.size() && next < scope_.size(); ++node)
      if (part.nodes[node] == scope_[next]) whole[node] = true, ++next;
    Denoised denoised = denoise_part(std::move(part), whole, threshold_, patch.buckets, exponent_.value_or(0));
    result_.removed_pairs = denoised.removed.size();
    if (result_.removed_pairs == 0) return;
    patch.graph = std::move(denoised.graph);
    patch.graph.positions = {};
    patch.redone = std::move(scope_);
    const std::vector<SweepKey>& stay = patch.graph.nodes;
    std::set_difference(patch.redone.begin(), patch.redone.end(), stay.begin(), stay.end(),
                        std::back_inserter(patch.gone));
    patch.memory = std::move(memory_);
    result_.patch = std::move(patch);
  }

  ArcBuckets scope_buckets() const {
    ArcBuckets all;
    if (!exponent_) return all;
    all.offsets.reserve(arcs_.records.size() + 1);
    all.buckets.reserve(static_cast<std::size_t>(size_.buckets));
    all.offsets.push_back(0);
    for (const StoredArc& arc : arcs_.records) {
      decode_buckets_of(arc, arcs_.payload(arc), *exponent_, all.buckets);
      all.offsets.push_back(all.buckets.size());
    }
    return all;
  }

  // Frees the stored arcs. With an embedding nodes have positions, for those that enter a bucket.
  ReebGraph scope_graph() {
    std::vector<ArcKeys> keys;
    keys.reserve(arcs_.records.size());
    for (const StoredArc& arc : arcs_.records) keys.push_back(arc.keys);
    arcs_ = {};
    ReebGraph graph = make_graph(std::move(keys), {});
    if (!exponent_) return graph;
    graph.positions.resize(graph.node_count());
    const SparseNodeTable table(graph.nodes);
    store_.scan_nodes([&](const SettledNode& stored) {
      const std::uint32_t node = table.find(stored.key);
      if (node != NodeTable::kNone) graph.positions[node] = stored.position;
    });
    return graph;
  }

  SegmentStore& store_;
  const double threshold_;
  const std::optional<int> exponent_;
  Reservation memory_;
  std::vector<SweepKey> scope_;  // nodes, ascending
  ScopeSize size_;
  RecordBatch<StoredArc> arcs_;
  LastNoisePass result_;
};

}  // namespace

LastNoisePass run_last_noise_pass(SegmentStore& store, double threshold, std::optional<int> bucket_exponent) {
  return Pass(store, threshold, bucket_exponent).run();
}

}  // namespace reeb::ooc
