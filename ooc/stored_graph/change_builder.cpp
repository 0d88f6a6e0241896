#include "ooc/stored_graph/change_builder.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include "libreeb/graph/packed_buckets.h"
#include "ooc/stored_graph/arc_payload.h"
#include "ooc/tables/node_table.h"

namespace reeb::ooc {
namespace {

ArcKeys keys_of(const ReebGraph& graph, std::size_t arc) {
  return {graph.nodes[graph.lo[arc].value()], graph.nodes[graph.hi[arc].value()]};
}

}  // namespace

ChangeBuilder::ChangeBuilder(MemoryBudget& budget, PassRoom& room, std::optional<int> exponent)
    : room_(room), exponent_(exponent) {
  change_.memory = budget.reserve("changes by noise removal", 0);
}

void ChangeBuilder::count_replaced(std::size_t arcs, const PackedLists& buckets) {
  change_.replaced_arcs += arcs;
  for (std::size_t arc = 0; arc < buckets.size(); ++arc) change_.replaced_buckets += packed_count(buckets.of(arc));
}

void ChangeBuilder::add(const Denoised& part, const PackedLists& buckets, const std::vector<SweepKey>& before,
                        const std::vector<NodeId>& former_hi, const std::vector<SweepKey>& places,
                        std::uint64_t enough) {
  reserve(part.graph.arc_count(), buckets, enough);
  for (std::size_t arc = 0; arc < part.graph.arc_count() && room_.fits(); ++arc)
    add_arc({keys_of(part.graph, arc), before[former_hi[part.former[arc].value()].value()]},
            exponent_ ? buckets.of(arc) : std::span<const std::byte>(), enough);
  std::set_difference(places.begin(), places.end(), part.graph.nodes.begin(), part.graph.nodes.end(),
                      std::back_inserter(change_.gone));
}

// There are few parts, so growing exactly is cheap.
void ChangeBuilder::reserve(std::size_t arc_count, const PackedLists& buckets, std::uint64_t enough) {
  constexpr std::size_t kExponent = 10;  // most bytes of an exponent in a payload
  std::size_t payloads = 0;
  for (std::size_t arc = 0; arc < buckets.size(); ++arc)
    if (const std::size_t size = buckets.of(arc).size(); size != 0) payloads += size + kExponent;
  auto& [records, pool] = change_.arcs;
  if (grow((records.size() + arc_count) * sizeof(ChangedArc), enough)) records.reserve(records.size() + arc_count);
  if (room_.fits() && grow(pool.size() + payloads, enough)) pool.reserve(pool.size() + payloads);
}

void ChangeBuilder::add_arc(const ChangedArc& arc, std::span<const std::byte> packed_buckets, std::uint64_t enough) {
  payload_.clear();
  if (exponent_) encode_packed_buckets(packed_buckets, *exponent_, payload_);
  constexpr std::size_t kPoolLimit = std::numeric_limits<std::uint32_t>::max();
  if (change_.arcs.pool.size() + payload_.size() > kPoolLimit) return room_.refuse(enough);
  change_.arcs.add(arc, payload_);
  change_.buckets += packed_count(packed_buckets);
}

bool ChangeBuilder::grow(std::uint64_t bytes, std::uint64_t enough) {
  const std::uint64_t now = change_.arcs.records.capacity() * sizeof(ChangedArc) + change_.arcs.pool.capacity() +
                            change_.gone.capacity() * sizeof(SweepKey);
  return room_.make(change_.memory, now + bytes, enough);
}

std::optional<GraphChange> ChangeBuilder::finish(std::vector<SweepKey> redone, std::uint64_t enough) {
  change_.redone = std::move(redone);
  const std::size_t count = change_.redone.capacity();
  if (!grow(count * sizeof(SweepKey) + SparseNodeTable::bytes(count), enough)) return {};
  std::sort(change_.gone.begin(), change_.gone.end());
  // Of parallel arcs, the one whose lowest part was stored first comes first; the payloads of a part are in its
  // order.
  std::sort(change_.arcs.records.begin(), change_.arcs.records.end(), [](const ChangedArc& a, const ChangedArc& b) {
    const auto key = [](const ChangedArc& arc) {
      return std::tuple(arc.keys.lo, arc.keys.hi, arc.former_hi, arc.payload.first, arc.payload.size);
    };
    return key(a) < key(b);
  });
  return std::move(change_);
}

}  // namespace reeb::ooc
