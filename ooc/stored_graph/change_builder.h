// Collects the change of a stored graph, part by part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/graph/packed_lists.h"
#include "libreeb/noise/denoise.h"
#include "ooc/stored_graph/graph_change.h"
#include "ooc/stored_graph/last_noise_pass.h"
#include "ooc/stored_graph/pass_room.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

class ChangeBuilder {
 public:
  // REQUIRES: `store`, `temp` and `room` outlive this, and `store` and `temp` also the change.
  ChangeBuilder(SegmentStore& store, const io::TempDir& temp, PassRoom& room, const LastNoiseOptions& options);

  // Arcs with these buckets will be replaced.
  void count_replaced(std::size_t arcs, const PackedLists& buckets);
  // What has become of a part of the graph. `before` and `former_hi` are its nodes and the upper ends of its arcs as
  // they were; `places` are the nodes whose arcs are replaced. If it does not fit the room, `enough` is recorded.
  void add(const Denoised& part, const PackedLists& buckets, const std::vector<SweepKey>& before,
           const std::vector<NodeId>& former_hi, const std::vector<SweepKey>& places, std::uint64_t enough);
  // Ends the change; `redone` are all places. Nothing if it does not fit.
  std::optional<GraphChange> finish(std::vector<SweepKey> redone, std::uint64_t enough);

 private:
  void add_arc(const ChangedArc& arc, std::span<const std::byte> packed_buckets);
  void add_gone(const ReebGraph& part, const std::vector<SweepKey>& places, std::uint64_t enough);
  bool make_sorting_room(std::uint64_t enough);

  MemoryBudget& budget_;
  PassRoom& room_;
  const std::optional<int> exponent_;
  std::uint64_t largest_payload_ = 0;
  std::vector<std::byte> payload_;
  GraphChange change_;
};

}  // namespace reeb::ooc
