// Where noise can be in a stored graph.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libreeb/base/sweep_key.h"
#include "ooc/stored_graph/last_noise_pass.h"
#include "ooc/stored_graph/pass_room.h"
#include "ooc/stored_graph/segment_store.h"
#include "ooc/tables/node_table.h"

namespace reeb::ooc {

// The nodes that noise removal can touch, ascending; for each the number of its arcs, and the memory for their buckets.
struct NoisePlaces {
  std::vector<SweepKey> nodes;
  std::vector<std::uint32_t> arcs;
  std::vector<std::uint64_t> bucket_bytes;

  std::size_t size() const { return nodes.size(); }
  static std::uint64_t bytes(std::uint64_t nodes) { return 28 * nodes; }
  // The rest is only needed to divide the nodes into parts.
  void keep_nodes() {
    std::vector<std::uint32_t>().swap(arcs);
    std::vector<std::uint64_t>().swap(bucket_bytes);
  }
  // The memory for removing noise at a node if no arc joins it to another of these nodes.
  std::uint64_t weight(std::size_t node) const;
};

// Nodes that can be worked on without the others.
struct NoiseParts {
  std::vector<std::uint32_t> part_of;  // by node of the places
  std::vector<std::uint64_t> weights;  // by part
};

// Whether an arc ends in one of these nodes.
inline auto meets(const SparseNodeTable& nodes) {
  return [&nodes](const ArcKeys& arc) {
    return nodes.find(arc.lo) != NodeTable::kNone || nodes.find(arc.hi) != NodeTable::kNone;
  };
}

// A stored graph in the last pass.
struct NoisyGraph {
  SegmentStore& store;
  const LastNoiseOptions& options;
  PassRoom& room;

  bool is_embedded() const { return options.bucket_exponent.has_value(); }
  // Memory for the buckets of an arc.
  std::uint64_t bucket_bytes(std::span<const std::byte> payload) const;
  // Calls visit(arc, batch) for all arcs that meet these nodes, as SegmentStore::scan_arcs does. If few arcs meet the
  // places of noise, these are not read again. REQUIRES: the nodes are places of noise.
  template <class Visit>
  void scan_meeting_arcs(const SparseNodeTable& nodes, const Visit& visit) const {
    if (!room.kept_arcs) return store.scan_arcs(meets(nodes), visit);
    for (const StoredArc& arc : room.kept_arcs->records)
      if (meets(nodes)(arc.keys)) visit(arc, *room.kept_arcs);
  }
};

// Keeps the arcs that meet the places if they are few. Returns nothing if it does not fit.
NoisePlaces find_noise_places(const NoisyGraph& graph);

// Nodes joined by an arc are in the same part. Parts are of about this size unless one set of joined nodes is larger.
// `held` bytes are in use, and `enough` is recorded if it does not fit.
NoiseParts divide(const NoisyGraph& graph, const NoisePlaces& places, std::uint64_t part_bytes, std::uint64_t held,
                  std::uint64_t enough);

}  // namespace reeb::ooc
