#include "ooc/stored_graph/change_builder.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "libreeb/graph/packed_buckets.h"
#include "ooc/sorting/sorted_run_merger.h"
#include "ooc/stored_graph/arc_payload.h"
#include "ooc/tables/node_table.h"

namespace reeb::ooc {
namespace {

constexpr const char* kOwner = "changes by noise removal";

ArcKeys keys_of(const ReebGraph& graph, std::size_t arc) {
  return {graph.nodes[graph.lo[arc].value()], graph.nodes[graph.hi[arc].value()]};
}

std::size_t largest_list(const PackedLists& lists) {
  std::size_t largest = 0;
  for (std::size_t i = 0; i < lists.size(); ++i) largest = std::max(largest, lists.of(i).size());
  return largest;
}

}  // namespace

ChangeBuilder::ChangeBuilder(SegmentStore& store, const io::TempDir& temp, PassRoom& room,
                             const LastNoiseOptions& options)
    : budget_(store.budget()), room_(room), exponent_(options.bucket_exponent) {
  change_.memory = budget_.reserve(kOwner, 0);
  change_.arcs = std::make_unique<ChangedArcs>(
      kOwner, temp, budget_, SortOptions{.allowance_bytes = options.change_bytes, .background = store.background()});
}

void ChangeBuilder::count_replaced(std::size_t arcs, const PackedLists& buckets) {
  change_.replaced_arcs += arcs;
  for (std::size_t arc = 0; arc < buckets.size(); ++arc) change_.replaced_buckets += packed_count(buckets.of(arc));
}

void ChangeBuilder::add(const Denoised& part, const PackedLists& buckets, const std::vector<SweepKey>& before,
                        const std::vector<NodeId>& former_hi, const std::vector<SweepKey>& places,
                        std::uint64_t enough) {
  constexpr std::uint64_t kExponent = 10;  // most bytes of an exponent in a payload
  largest_payload_ = std::max(largest_payload_, largest_list(buckets) + kExponent);
  if (!make_sorting_room(enough)) return;
  for (std::size_t arc = 0; arc < part.graph.arc_count(); ++arc)
    add_arc({keys_of(part.graph, arc), before[former_hi[part.former[arc].value()].value()]},
            exponent_ ? buckets.of(arc) : std::span<const std::byte>());
  add_gone(part.graph, places, enough);
}

void ChangeBuilder::add_arc(const ChangedArc& arc, std::span<const std::byte> packed_buckets) {
  payload_.clear();
  if (exponent_) encode_list(packed_buckets, *exponent_, payload_);
  change_.arcs->add(arc, payload_);
  change_.buckets += packed_count(packed_buckets);
}

// There are few parts, so growing exactly is cheap.
void ChangeBuilder::add_gone(const ReebGraph& part, const std::vector<SweepKey>& places, std::uint64_t enough) {
  auto& gone = change_.gone;
  const std::size_t most = gone.size() + places.size();
  if (!room_.make(change_.memory, (gone.capacity() + most) * sizeof(SweepKey), enough)) return;
  gone.reserve(most);
  std::set_difference(places.begin(), places.end(), part.nodes.begin(), part.nodes.end(), std::back_inserter(gone));
}

// The arcs reserve their own memory. This only finds out whether they can: at least a block and a payload to collect
// them, and two blocks to merge them.
bool ChangeBuilder::make_sorting_room(std::uint64_t enough) {
  Reservation probe = budget_.reserve(kOwner, 0);
  return room_.make(probe, 6 * (kRunBlockBytes + largest_payload_), enough);
}

std::optional<GraphChange> ChangeBuilder::finish(std::vector<SweepKey> redone, std::uint64_t enough) {
  constexpr std::uint64_t kMergeLimitBytes = 64 << 20;
  change_.redone = std::move(redone);
  const std::size_t redone_count = change_.redone.capacity(), list_nodes = redone_count + change_.gone.capacity();
  const std::uint64_t bytes = list_nodes * sizeof(SweepKey) + SparseNodeTable::bytes(redone_count);
  if (!room_.make(change_.memory, bytes, enough) || !make_sorting_room(enough)) return {};
  std::sort(change_.gone.begin(), change_.gone.end());
  change_.arcs->finish(std::min(budget_.free_bytes() / 8, kMergeLimitBytes));
  return std::move(change_);
}

}  // namespace reeb::ooc
