#include "ooc/stored_graph/last_noise_pass.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "libreeb/base/union_find.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/hierarchy/denoise.h"
#include "libreeb/hierarchy/noise_scope.h"
#include "ooc/stored_graph/arc_ends.h"
#include "ooc/stored_graph/arc_payload.h"
#include "ooc/tables/node_table.h"

namespace reeb::ooc {
namespace {

// Memory to remove leaves in a part of the graph: per node; per arc with two ends in the part, and with one; and per
// byte of packed buckets, and per unpacked bucket.
constexpr std::uint64_t kNodeBytes = 72, kInnerArcBytes = 64, kArcBytes = kInnerArcBytes + kNodeBytes;
constexpr std::uint64_t kPackedByte = 1, kBucketBytes = 42;

// Memory to find the scope in a graph of short arcs: the graph, the degrees of its nodes and the size of their buckets,
// and either the table that finds nodes or what noise_scope() takes.
std::uint64_t search_bytes(std::uint64_t arcs, std::uint64_t nodes) {
  constexpr std::uint64_t kNode = sizeof(SweepKey) + 16, kArc = 2 * sizeof(NodeId), kScopeNode = 25, kScopeArc = 12;
  return kNode * nodes + kArc * arcs + std::max(SparseNodeTable::bytes(nodes), kScopeNode * nodes + kScopeArc * arcs);
}

// Memory to make that graph from arcs in a vector of this capacity.
std::uint64_t short_graph_bytes(std::uint64_t arcs, std::uint64_t capacity) {
  return sizeof(ArcKeys) * capacity + (4 * sizeof(SweepKey) + 2 * sizeof(NodeId)) * arcs;
}

// Growing by a quarter copies little and leaves little unused.
std::size_t next_capacity(std::size_t capacity) { return std::max<std::size_t>(1024, capacity + capacity / 4); }

// The nodes that noise removal can touch, ascending; for each the number of its arcs, and the memory for their buckets.
struct Scope {
  std::vector<SweepKey> nodes;
  std::vector<std::uint32_t> arcs;
  std::vector<std::uint64_t> bucket_bytes;

  std::size_t size() const { return nodes.size(); }
  static std::uint64_t bytes(std::uint64_t nodes) { return 28 * nodes; }
  void reserve(std::size_t count) {
    nodes.reserve(count);
    arcs.reserve(count);
    bucket_bytes.reserve(count);
  }
  void add(const SweepKey& node, std::uint32_t arc_count, std::uint64_t of_buckets) {
    nodes.push_back(node);
    arcs.push_back(arc_count);
    bucket_bytes.push_back(of_buckets);
  }
  // The rest is only needed to divide the nodes into parts.
  void keep_nodes() {
    arcs = {};
    bucket_bytes = {};
  }
  // The memory for removing noise at a node if no arc joins it to another node of the scope.
  std::uint64_t weight(std::size_t node) const { return kNodeBytes + kArcBytes * arcs[node] + bucket_bytes[node]; }
};

// Whether an arc ends in one of these nodes.
auto meets(const SparseNodeTable& nodes) {
  return [&nodes](const ArcKeys& arc) {
    return nodes.find(arc.lo) != NodeTable::kNone || nodes.find(arc.hi) != NodeTable::kNone;
  };
}

class NoisePass {
 public:
  NoisePass(SegmentStore& store, const LastNoiseOptions& options)
      : store_(store),
        options_(options),
        exponent_(options.bucket_exponent),
        memory_(store.budget().reserve("last pass of noise removal", 0)),
        spare_memory_(store.budget().reserve("last pass of noise removal", 0)) {
    change_.memory = store.budget().reserve("changes by noise removal", 0);
  }

  LastNoisePass run() {
    find_scope();
    if (result_.fits && scope_.size() != 0) remove_noise();
    if (result_.fits && result_.removed_pairs != 0) finish_change();
    return std::move(result_);
  }

 private:
  // Whether there is room. If not, `enough` is recorded as the memory needed.
  bool make_room(Reservation& memory, std::uint64_t bytes, std::uint64_t enough) {
    if (!result_.fits) return false;
    result_.fits = memory.try_resize(bytes);
    if (!result_.fits && spare_memory_.bytes() != 0) {
      release_spare_memory();
      result_.fits = memory.try_resize(bytes);
    }
    if (!result_.fits) result_.needed_bytes = enough;
    return result_.fits;
  }

  // Releases memory that only saves time.
  void release_spare_memory() {
    ends_.reset();
    kept_arcs_.reset();
    spare_memory_.release();
  }

  // The memory for removing noise if all of the graph is touched, including the change.
  std::uint64_t most_bytes() const {
    const std::uint64_t of_buckets =
        exponent_ ? kPackedByte * store_.payload_bytes() + kBucketBytes * store_.bucket_count() : 0;
    constexpr std::uint64_t kGoneNode = 2 * sizeof(SweepKey) + 20;
    const std::uint64_t of_change = sizeof(ChangedArc) * store_.arc_count() + (exponent_ ? store_.payload_bytes() : 0) +
                                    kGoneNode * store_.node_count();
    return kNodeBytes * store_.node_count() + kInnerArcBytes * store_.arc_count() + of_buckets + of_change;
  }

  // ---- where noise can be

  void find_scope() {
    std::vector<ArcKeys> found = find_short_arcs();
    release_spare_memory();
    if (!result_.fits || found.empty()) return;
    const ReebGraph short_arcs = make_graph(std::move(found), {});
    const std::uint64_t bytes = search_bytes(short_arcs.arc_count(), short_arcs.node_count());
    if (!make_room(memory_, bytes, bytes + most_bytes())) return;
    Degrees degrees{std::vector<std::uint32_t>(short_arcs.node_count()),
                    std::vector<std::uint32_t>(short_arcs.node_count())};
    std::vector<std::uint64_t> of_buckets(short_arcs.node_count());
    look_at_ends(short_arcs, degrees, of_buckets);
    const std::vector<bool> in_scope = noise_scope(short_arcs, degrees);
    const auto size = static_cast<std::size_t>(std::count(in_scope.begin(), in_scope.end(), true));
    if (!make_room(memory_, bytes + Scope::bytes(size), bytes + most_bytes())) return;
    scope_.reserve(size);
    for (std::size_t node = 0; node < in_scope.size(); ++node)
      if (in_scope[node]) scope_.add(short_arcs.nodes[node], degrees.down[node] + degrees.up[node], of_buckets[node]);
  }

  // Short arcs that end in an extremum, plus those connected to them; or all short arcs if that takes too long to tell.
  std::vector<ArcKeys> find_short_arcs() {
    std::vector<ArcKeys> found;
    std::uint64_t count = 0;
    note_ends();
    store_.scan_arc_keys([&](const ArcKeys& arc) {
      if (ends_) ends_->add(arc);
      if (!is_short(arc.lo.value, arc.hi.value, options_.threshold)) return;
      ++count;
      if (result_.fits && found.size() == found.capacity()) grow(found);
      if (result_.fits) found.push_back(arc);
    });
    if (ends_) ends_->keep_connected_to_extrema(found);
    make_room(memory_, short_graph_bytes(found.size(), found.capacity()), 0);
    if (result_.fits) return found;
    result_.needed_bytes =
        short_graph_bytes(count, 2 * count + next_capacity(0)) + search_bytes(count, 2 * count) + most_bytes();
    return {};
  }

  // Worthwhile if the graph is not small compared with the mesh.
  void note_ends() {
    const std::uint64_t bytes = ArcEnds::bytes(options_.vertices), few = sizeof(ArcKeys) / 8 * store_.arc_count();
    if (options_.vertices != 0 && bytes <= few && spare_memory_.try_resize(bytes)) ends_.emplace(options_.vertices);
  }

  void grow(std::vector<ArcKeys>& arcs) {
    const std::size_t before = arcs.capacity(), after = next_capacity(before);
    if (make_room(memory_, (before + after) * sizeof(ArcKeys), 0))
      arcs.reserve(after);
    else
      std::vector<ArcKeys>().swap(arcs);
  }

  // Finds the degrees of these nodes in the whole graph, and the memory for the buckets of all their arcs. Keeps these
  // arcs if they are few.
  void look_at_ends(const ReebGraph& graph, Degrees& degrees, std::vector<std::uint64_t>& of_buckets) {
    const SparseNodeTable table(graph.nodes);
    if (spare_memory_.try_resize(options_.part_bytes)) kept_arcs_.emplace();
    store_.scan_arcs(meets(table), [&](const StoredArc& arc, const auto& batch) {
      const std::uint32_t lo = table.find(arc.keys.lo), hi = table.find(arc.keys.hi);
      const std::span<const std::byte> payload = batch.payload(arc);
      const std::uint64_t bytes = bucket_bytes(payload);
      if (lo != NodeTable::kNone) ++degrees.up[lo], of_buckets[lo] += bytes;
      if (hi != NodeTable::kNone) ++degrees.down[hi], of_buckets[hi] += bytes;
      if (kept_arcs_) keep_arc(arc, payload);
    });
  }

  // Vectors that grow take up to three times their content.
  void keep_arc(const StoredArc& arc, std::span<const std::byte> payload) {
    if (kept_arcs_->bytes() + sizeof(arc) + payload.size() <= options_.part_bytes / 3)
      kept_arcs_->add(arc, payload);
    else
      release_spare_memory();
  }

  // Calls visit(arc, batch) for all arcs that meet these nodes of the scope, as scan_arcs does.
  template <class Visit>
  void scan_meeting_arcs(const SparseNodeTable& nodes, const Visit& visit) const {
    if (!kept_arcs_) return store_.scan_arcs(meets(nodes), visit);
    for (const StoredArc& arc : kept_arcs_->records)
      if (meets(nodes)(arc.keys)) visit(arc, *kept_arcs_);
  }

  std::uint64_t bucket_bytes(std::span<const std::byte> payload) const {
    return exponent_ ? kPackedByte * payload.size() + kBucketBytes * bucket_count(payload) : 0;
  }

  // ---- removing it, in independent parts

  void remove_noise() {
    constexpr std::uint64_t kParts = 16;
    std::uint64_t all = 0;
    for (std::size_t node = 0; node < scope_.size(); ++node) all += scope_.weight(node);
    held_ = Scope::bytes(scope_.size()) + sizeof(std::uint32_t) * scope_.size();
    enough_ = held_ + 2 * all;
    if (!make_room(memory_, held_, enough_)) return;
    const std::uint64_t part_bytes =
        std::min(std::max(options_.part_bytes, all / kParts), store_.budget().free_bytes() / 2);
    if (all <= part_bytes) {
      scope_.keep_nodes();
      return remove_noise_in(scope_.nodes, all);
    }
    const Division division = divide(part_bytes);
    scope_.keep_nodes();
    for (std::uint32_t part = 0; part < division.weights.size() && result_.fits; ++part) {
      std::vector<SweepKey> nodes;
      nodes.reserve(static_cast<std::size_t>(std::count(division.part_of.begin(), division.part_of.end(), part)));
      for (std::size_t node = 0; node < scope_.size(); ++node)
        if (division.part_of[node] == part) nodes.push_back(scope_.nodes[node]);
      remove_noise_in(nodes, division.weights[part] + sizeof(SweepKey) * nodes.size());
    }
  }

  struct Division {
    std::vector<std::uint32_t> part_of;  // by node of the scope
    std::vector<std::uint64_t> weights;  // by part
  };

  // Nodes joined by an arc are in the same part. Parts are of about this size unless one set of joined nodes is larger.
  Division divide(std::uint64_t part_bytes) {
    const auto count = static_cast<std::uint32_t>(scope_.size());
    if (!make_room(memory_, held_ + SparseNodeTable::bytes(count) + 20ull * count, enough_)) return {};
    UnionFind joined(count);
    std::vector<std::uint64_t> weights(count);
    for (std::uint32_t node = 0; node < count; ++node) weights[node] = scope_.weight(node);
    join_neighbours(joined, weights);
    for (std::uint32_t node = 0; node < count; ++node)
      if (joined.find(node) != node) weights[joined.find(node)] += weights[node];
    Division division{std::vector<std::uint32_t>(count), {}};
    for (std::uint32_t node = 0; node < count; ++node) {
      if (joined.find(node) != node) continue;
      if (division.weights.empty() || division.weights.back() + weights[node] > part_bytes)
        division.weights.push_back(0);
      division.weights.back() += weights[node];
      division.part_of[node] = static_cast<std::uint32_t>(division.weights.size() - 1);
    }
    for (std::uint32_t node = 0; node < count; ++node) division.part_of[node] = division.part_of[joined.find(node)];
    enough_ = memory_.bytes() +
              2 * std::accumulate(division.weights.begin(), division.weights.end(), std::uint64_t{0}) +
              Scope::bytes(2 * count);
    return division;
  }

  // An arc between two nodes of the scope was counted at both nodes.
  void join_neighbours(UnionFind& joined, std::vector<std::uint64_t>& weights) const {
    const SparseNodeTable table(scope_.nodes);
    scan_meeting_arcs(table, [&](const StoredArc& arc, const auto& batch) {
      const std::uint32_t lo = table.find(arc.keys.lo), hi = table.find(arc.keys.hi);
      if (lo == NodeTable::kNone || hi == NodeTable::kNone) return;
      joined.unite(lo, hi);
      weights[lo] -= kArcBytes + bucket_bytes(batch.payload(arc));
      weights[hi] -= kArcBytes - kInnerArcBytes;
    });
  }

  void remove_noise_in(const std::vector<SweepKey>& scope, std::uint64_t bytes) {
    if (!make_room(memory_, held_ + bytes, enough_)) return;
    RecordBatch<StoredArc> arcs = gather(scope);
    PackedLists buckets = buckets_of(arcs);
    change_.replaced_arcs += arcs.records.size();
    for (std::size_t arc = 0; arc < buckets.size(); ++arc) change_.replaced_buckets += packed_count(buckets.of(arc));
    ReebGraph part = graph_of(std::move(arcs));
    std::vector<bool> whole(part.node_count());
    for (std::size_t node = 0, next = 0; next < scope.size(); ++node)
      if (part.nodes[node] == scope[next]) whole[node] = true, ++next;
    if (exponent_) find_positions(part, whole);
    const std::vector<SweepKey> former_nodes = part.nodes;
    const std::vector<NodeId> former_hi = part.hi;
    const Denoised denoised = denoise_part(std::move(part), whole, options_.threshold, buckets, exponent_.value_or(0));
    result_.removed_pairs += denoised.removed.size();
    memory_.try_resize(held_ + bytes / 2);  // most of it is free again
    make_room_in_change(denoised.graph.arc_count(), buckets);
    for (std::size_t arc = 0; arc < denoised.graph.arc_count() && result_.fits; ++arc)
      add_to_change({keys_of(denoised.graph, arc), former_nodes[former_hi[denoised.former[arc].value()].value()]},
                    exponent_ ? buckets.of(arc) : std::span<const std::byte>());
    add_gone(scope, denoised.graph.nodes);
  }

  static ArcKeys keys_of(const ReebGraph& graph, std::size_t arc) {
    return {graph.nodes[graph.lo[arc].value()], graph.nodes[graph.hi[arc].value()]};
  }

  // All arcs of these nodes with their payloads, in the order of the graph. They are counted first, since growing
  // vectors would take twice the memory.
  RecordBatch<StoredArc> gather(const std::vector<SweepKey>& scope) const {
    const SparseNodeTable table(scope);
    const auto for_each = [&](const auto& visit) {
      scan_meeting_arcs(table, [&](const StoredArc& arc, const auto& batch) {
        visit(arc, exponent_ ? batch.payload(arc) : std::span<const std::byte>());
      });
    };
    std::size_t count = 0, payload_bytes = 0;
    for_each([&](const StoredArc&, std::span<const std::byte> payload) {
      ++count;
      payload_bytes += payload.size();
    });
    RecordBatch<StoredArc> arcs;
    arcs.records.reserve(count);
    arcs.pool.reserve(payload_bytes);
    for_each([&](const StoredArc& arc, std::span<const std::byte> payload) { arcs.add(arc, payload); });
    std::sort(arcs.records.begin(), arcs.records.end(), SortedArcs::in_order);
    return arcs;
  }

  PackedLists buckets_of(const RecordBatch<StoredArc>& arcs) const {
    PackedLists all;
    if (!exponent_) return all;
    all.reserve(arcs.records.size());
    std::vector<Bucket> own;
    for (const StoredArc& arc : arcs.records) {
      own.clear();
      decode_buckets_of(arc.keys, arcs.payload(arc), *exponent_, own);
      all.add(own);
    }
    return all;
  }

  static ReebGraph graph_of(RecordBatch<StoredArc> arcs) {
    std::vector<ArcKeys> keys;
    keys.reserve(arcs.records.size());
    for (const StoredArc& arc : arcs.records) keys.push_back(arc.keys);
    arcs = {};
    return make_graph(std::move(keys), {});
  }

  // Finds the positions of the wanted nodes of a part: those that can enter a bucket.
  void find_positions(ReebGraph& part, const std::vector<bool>& wanted) const {
    part.positions.resize(part.node_count());
    const SparseNodeTable table(part.nodes);
    const auto is_wanted = [&](const SweepKey& key) {
      const std::uint32_t node = table.find(key);
      return node != NodeTable::kNone && wanted[node];
    };
    store_.scan_nodes(is_wanted,
                      [&](const SettledNode& stored) { part.positions[table.find(stored.key)] = stored.position; });
  }

  // ---- the change

  // For this many arcs with these buckets. There are few parts, so growing exactly is cheap.
  void make_room_in_change(std::size_t arc_count, const PackedLists& buckets) {
    constexpr std::size_t kExponent = 10;  // most bytes of an exponent in a payload
    std::size_t payloads = 0;
    for (std::size_t arc = 0; arc < buckets.size(); ++arc)
      if (const std::size_t size = buckets.of(arc).size(); size != 0) payloads += size + kExponent;
    auto& [records, pool] = change_.arcs;
    if (grow_change((records.size() + arc_count) * sizeof(ChangedArc))) records.reserve(records.size() + arc_count);
    if (result_.fits && grow_change(pool.size() + payloads)) pool.reserve(pool.size() + payloads);
  }

  void add_to_change(const ChangedArc& arc, std::span<const std::byte> packed_buckets) {
    payload_.clear();
    if (exponent_) encode_packed_buckets(packed_buckets, *exponent_, payload_);
    constexpr std::size_t kPoolLimit = std::numeric_limits<std::uint32_t>::max();
    if (change_.arcs.pool.size() + payload_.size() > kPoolLimit) {
      result_.fits = false;
      result_.needed_bytes = enough_;
      return;
    }
    change_.arcs.add(arc, payload_);
    change_.buckets += packed_count(packed_buckets);
  }

  std::uint64_t change_bytes() const {
    return change_.arcs.records.capacity() * sizeof(ChangedArc) + change_.arcs.pool.capacity() +
           change_.gone.capacity() * sizeof(SweepKey);
  }
  bool grow_change(std::uint64_t bytes) { return make_room(change_.memory, change_bytes() + bytes, enough_); }

  // Adds the nodes that are in `before` but not in `after`. Both ascend.
  void add_gone(const std::vector<SweepKey>& before, const std::vector<SweepKey>& after) {
    std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(change_.gone));
  }

  void finish_change() {
    change_.redone = std::move(scope_.nodes);
    scope_ = {};
    memory_.release();
    const std::size_t redone = change_.redone.capacity();
    if (!grow_change(redone * sizeof(SweepKey) + SparseNodeTable::bytes(redone))) return;
    std::sort(change_.gone.begin(), change_.gone.end());
    // Of parallel arcs, the one whose lowest part was stored first comes first; the payloads of a part are in its
    // order.
    std::sort(change_.arcs.records.begin(), change_.arcs.records.end(), [](const ChangedArc& a, const ChangedArc& b) {
      const auto key = [](const ChangedArc& arc) {
        return std::tuple(arc.keys.lo, arc.keys.hi, arc.former_hi, arc.payload.first, arc.payload.size);
      };
      return key(a) < key(b);
    });
    result_.change = std::move(change_);
  }

  SegmentStore& store_;
  const LastNoiseOptions options_;
  const std::optional<int> exponent_;
  Reservation memory_;
  Reservation spare_memory_;                         // of one of the next two, never both:
  std::optional<ArcEnds> ends_;                      // during the search for short arcs
  std::optional<RecordBatch<StoredArc>> kept_arcs_;  // all arcs of the scope's nodes, and some others, if they are few
  Scope scope_;
  std::uint64_t held_ = 0;    // bytes of memory_ for the scope
  std::uint64_t enough_ = 0;  // bytes that are enough to remove its noise
  std::vector<std::byte> payload_;
  GraphChange change_;
  LastNoisePass result_;
};

}  // namespace

LastNoisePass run_last_noise_pass(SegmentStore& store, const LastNoiseOptions& options) {
  return NoisePass(store, options).run();
}

}  // namespace reeb::ooc
