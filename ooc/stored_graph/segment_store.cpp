#include "ooc/stored_graph/segment_store.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <string>

#include "libreeb/base/byte_coding.h"
#include "libreeb/base/prefetch.h"
#include "libreeb/graph/packed_buckets.h"
#include "ooc/sorting/column_codec.h"
#include "ooc/threads/worker.h"

namespace reeb::ooc {

namespace {

std::uint64_t bits(const SweepKey& key) { return ordered_bits(key.value); }
std::uint64_t id(const SweepKey& key) { return key.vertex.value(); }

// A column of the differences of `number` from each record to the next, the first from 0.
template <class Record, class Number>
void add_differences(ColumnEncoder& columns, std::span<const Record> records, const Number& number) {
  columns.add(records.size(),
              [&](std::size_t i) { return zigzag(number(records[i]) - (i == 0 ? 0 : number(records[i - 1]))); });
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
  columns.pack(packed);
  for (std::size_t k = 0; k < 3; ++k)
    columns.add(nodes.size(), [&](std::size_t i) { return std::bit_cast<std::uint64_t>(nodes[i].position[k]); });
  columns.pack(packed);
}

namespace {

// Decodes the keys. The result's tail is what follows them.
ColumnDecoder decode_node_keys(std::span<const std::byte> packed, std::span<SettledNode> nodes) {
  ColumnDecoder columns(packed, 2, nodes.size());
  if (!columns.ok()) return columns;
  for_sums(columns.column(0), [&](std::size_t i, std::uint64_t sum) { nodes[i].key.value = from_ordered_bits(sum); });
  for_sums(columns.column(1), [&](std::size_t i, std::uint64_t sum) { nodes[i].key.vertex = VertexId(sum); });
  return columns;
}

}  // namespace

bool NodeCodec::decode_keys(std::span<const std::byte> packed, std::span<SettledNode> nodes) {
  return decode_node_keys(packed, nodes).ok();
}

bool NodeCodec::decode(std::span<const std::byte> packed, std::span<SettledNode> nodes) {
  const ColumnDecoder keys = decode_node_keys(packed, nodes);
  if (!keys.ok()) return false;
  ColumnDecoder columns(keys.tail(), 3, nodes.size());
  if (!columns.ok() || !columns.tail().empty()) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto column = columns.column(k);
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].position[k] = std::bit_cast<double>(column[i]);
  }
  return true;
}

namespace {

// After sorting, the payloads are anywhere in the pool, so they are prefetched.
void add_payloads(std::span<const StoredArc> arcs, std::span<const std::byte> pool, std::vector<std::byte>& packed) {
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (i + kAhead < arcs.size()) prefetch(pool.data() + arcs[i + kAhead].payload.first);
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

namespace {

// Decodes the keys. The last column and the tail remain in the result.
ColumnDecoder decode_arc_keys(std::span<const std::byte> packed, std::span<StoredArc> arcs) {
  ColumnDecoder columns(packed, 5, arcs.size());
  if (!columns.ok()) return columns;
  for_sums(columns.column(0),
           [&](std::size_t i, std::uint64_t sum) { arcs[i].keys.lo.value = from_ordered_bits(sum); });
  for_sums(columns.column(1), [&](std::size_t i, std::uint64_t sum) { arcs[i].keys.lo.vertex = VertexId(sum); });
  auto column = columns.column(2);
  for (std::size_t i = 0; i < arcs.size(); ++i)
    arcs[i].keys.hi.value = from_ordered_bits(bits(arcs[i].keys.lo) + column[i]);
  column = columns.column(3);
  for (std::size_t i = 0; i < arcs.size(); ++i)
    arcs[i].keys.hi.vertex = VertexId(id(arcs[i].keys.lo) + unzigzag(column[i]));
  return columns;
}

}  // namespace

bool ArcCodec::decode_keys(std::span<const std::byte> packed, std::span<StoredArc> arcs) {
  return decode_arc_keys(packed, arcs).ok();
}

bool ArcCodec::decode(std::span<const std::byte> packed, std::span<StoredArc> arcs, std::vector<std::byte>& pool) {
  ColumnDecoder columns = decode_arc_keys(packed, arcs);
  if (!columns.ok()) return false;
  const auto column = columns.column(4);
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < arcs.size(); first += column[i++]) {
    if (column[i] > columns.tail().size() - first) return false;
    arcs[i].payload = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(column[i])};
  }
  pool.assign(columns.tail().begin(), columns.tail().end());
  return first == pool.size();
}

namespace {

SortOptions half_of(const SegmentOptions& options, const char* suffix) {
  return {.allowance_bytes = options.allowance_bytes / 2,
          .most_bytes = options.most_bytes / 2,
          .background = options.background,
          .file = options.files.empty() ? "" : options.files + suffix,
          .poll = options.poll};
}

}  // namespace

SegmentStore::SegmentStore(const io::TempDir& temp, MemoryBudget& budget, const SegmentOptions& options)
    : budget_(&budget),
      background_(options.background),
      poll_(options.poll),
      nodes_("settled nodes", temp, budget, half_of(options, ".nodes")),
      arcs_("settled arcs", temp, budget, half_of(options, ".arcs")) {}

void SegmentStore::add_arcs(const SettledArcs& settled) {
  if (settled.lists.empty()) {
    constexpr std::size_t kArcsAtOnce = 1024;
    for (std::size_t first = 0; first < settled.arcs.size(); first += kArcsAtOnce) {
      plain_.clear();
      for (const ArcKeys& arc : settled.arcs.subspan(first, std::min(kArcsAtOnce, settled.arcs.size() - first)))
        plain_.push_back({arc});
      arcs_.add(plain_);
    }
    return;
  }
  for (std::size_t i = 0; i < settled.arcs.size(); ++i) {
    const std::span<const std::byte> list = settled.lists.of(i);
    payload_.clear();
    encode_list(list, settled.bucket_exponent, payload_);
    arcs_.add({settled.arcs[i]}, payload_);
    payload_bytes_ += payload_.size();
    bucket_count_ += packed_count(list);
  }
}

void SegmentStore::save(StateWriter& out) {
  out.put(bucket_count_);
  out.put(payload_bytes_);
  nodes_.save(out);
  arcs_.save(out);
}

void SegmentStore::restore(StateReader& in) {
  in.get(bucket_count_);
  in.get(payload_bytes_);
  const auto is_sound = [this](const SweepKey& key) {
    restored_vertex_bound_ = std::max(restored_vertex_bound_, key.vertex.value() + 1);
    return std::isfinite(key.value) && key.vertex.value() + 1 != 0;
  };
  nodes_.restore(in, [&](const SettledNode& node) { return is_sound(node.key); });
  arcs_.restore(in, [&](const StoredArc& arc) {
    return is_sound(arc.keys.lo) && is_sound(arc.keys.hi) && arc.keys.lo < arc.keys.hi;
  });
}

void SegmentStore::finish() {
  constexpr std::uint64_t kMergeLimitBytes = 64 << 20;  // a thousand runs
  const std::uint64_t merge_bytes = std::min(budget_->free_bytes() / 8, kMergeLimitBytes);
  if (!background_) {
    arcs_.finish(merge_bytes, poll_);
    nodes_.finish(merge_bytes, poll_);
    return;
  }
  // The other thread must not wait for the end of its merge if this one is interrupted.
  struct Stopped {};
  std::atomic<bool> stopped = false;
  Worker worker;
  worker.start([&] {
    nodes_.finish(merge_bytes, [&] {
      if (stopped) throw Stopped();
    });
  });
  try {
    arcs_.finish(merge_bytes, poll_);
    worker.wait([&] {
      if (poll_) poll_();
    });
  } catch (...) {
    stopped = true;
    throw;
  }
}

namespace {

[[noreturn]] void refuse_payload(const ArcKeys& arc, int bucket_exponent) {
  throw BrokenGraph("the buckets of an arc from vertex " + std::to_string(arc.lo.vertex.value()) +
                    " are not buckets of exponent " + std::to_string(bucket_exponent));
}

}  // namespace

void decode_buckets_of(const ArcKeys& arc, std::span<const std::byte> payload, int bucket_exponent,
                       std::vector<Bucket>& buckets) {
  if (!decode_buckets(payload, bucket_exponent, buckets)) refuse_payload(arc, bucket_exponent);
}

std::uint64_t SegmentStore::reserved_bytes() const {
  return nodes_.reserved_bytes() + arcs_.reserved_bytes() + (change_ ? change_->change().reserved_bytes() : 0);
}

void SegmentStore::rewind_nodes() {
  nodes_.rewind();
  last_node_.reset();
  if (change_) change_->rewind_nodes();
}

void SegmentStore::set_aside() {
  nodes_.set_aside();
  arcs_.set_aside();
}

void SegmentStore::rewind_arcs() {
  arcs_.rewind();
  batch_.clear();
  next_ = 0;
  at_end_ = false;
  if (change_) change_->rewind_arcs();
}

bool SegmentStore::read_nodes(std::vector<SettledNode>& nodes, std::size_t limit) {
  while (nodes_.read(nodes, limit)) {
    for (const SettledNode& node : nodes) {
      if (last_node_ && !(*last_node_ < node.key))
        throw BrokenGraph("vertex " + std::to_string(node.key.vertex.value()) + " is a node twice");
      last_node_ = node.key;
    }
    if (change_) std::erase_if(nodes, [&](const SettledNode& node) { return change_->drops(node.key); });
    if (!nodes.empty()) return true;
  }
  return false;
}

// Calls take(keys, payload) for the next arcs in order, at most `limit`.
template <class Take>
bool SegmentStore::take_arcs(std::size_t limit, const Take& take) {
  std::size_t taken = 0;
  while (taken < limit) {
    if (next_ == batch_.records.size() && !at_end_) {
      if (taken != 0) break;  // a piece comes from one batch
      refill_arcs(limit);
      continue;
    }
    const StoredArc* stored = at_end_ ? nullptr : &batch_.records[next_];
    if (change_ && change_->comes_before(stored == nullptr ? nullptr : &stored->keys)) {
      const ChangedArc& arc = change_->take();
      take(arc.keys, change_->payload(arc));
      ++taken;
      continue;
    }
    if (stored == nullptr) break;
    ++next_;
    if (change_ && change_->drops(stored->keys)) continue;
    take(stored->keys, batch_.payload(*stored));
    ++taken;
  }
  return taken != 0;
}

bool SegmentStore::read_arcs(ArcPiece& piece, std::size_t limit, std::optional<int> bucket_exponent) {
  piece.arcs.clear();
  piece.lists.clear();
  return take_arcs(limit, [&](const ArcKeys& arc, std::span<const std::byte> payload) {
    piece.arcs.push_back(arc);
    if (!bucket_exponent) return;
    const auto list = packed_list(payload, *bucket_exponent, coarsened_);
    if (!list) refuse_payload(arc, *bucket_exponent);
    piece.lists.add_packed(*list);
  });
}

void SegmentStore::refill_arcs(std::size_t limit) {
  constexpr std::size_t kPayloads = 256 << 10;
  at_end_ = !arcs_.read(batch_, limit, kPayloads);
  next_ = 0;
}

void SegmentStore::apply(GraphChange change) {
  change_.emplace(std::move(change));
  rewind_nodes();
  rewind_arcs();
}

std::uint64_t SegmentStore::node_count() const { return nodes_.size() - (change_ ? change_->change().gone.size() : 0); }

std::uint64_t SegmentStore::arc_count() const {
  if (!change_) return arcs_.size();
  return arcs_.size() - change_->change().replaced_arcs + change_->change().arcs->size();
}

std::uint64_t SegmentStore::bucket_count() const {
  if (!change_) return bucket_count_;
  return bucket_count_ - change_->change().replaced_buckets + change_->change().buckets;
}

void copy_graph(SegmentStore& from, SegmentStore& to, std::optional<int> bucket_exponent,
                const std::function<void()>& poll) {
  constexpr std::size_t kRecordsAtOnce = 4096;
  from.rewind_nodes();
  for (std::vector<SettledNode> nodes; from.read_nodes(nodes, kRecordsAtOnce); poll()) to.add_nodes(nodes);
  from.rewind_arcs();
  for (ArcPiece piece; from.read_arcs(piece, kRecordsAtOnce, bucket_exponent); poll())
    to.add_arcs({piece.arcs, piece.lists.view(), bucket_exponent.value_or(0)});
}

}  // namespace reeb::ooc
