// The sizes of all versions of a hierarchy, while its records are read for the layout of its file.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/prefetch.h"
#include "libreeb/format/frame_codec.h"
#include "libreeb/graph/arc_version.h"

namespace reeb::ooc {

// An arc record and the number of its buckets.
struct CountedArc {
  ArcVersion arc;
  std::uint32_t buckets;
};

// Counts nodes, arcs and buckets of every version from records that come by `died` descending.
//
// MEMORY: 4 bytes per node, 32 per version.   TIME: O(1) per record.
class VersionCounter {
 public:
  VersionCounter(std::size_t node_count, std::size_t versions) : present_from_(node_count, kNever), change_(versions) {}

  void add(std::span<const CountedArc> arcs) {
    constexpr std::size_t kAhead = 8;
    for (const auto& [arc, buckets] : arcs) prefetch(arc);  // its nodes can be anywhere in memory
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      if (i + kAhead < arcs.size()) prefetch_next(arcs[i + kAhead].arc);
      const auto& [arc, buckets] = arcs[i];
      arrives(arc.born, arc.died, {.arcs = 1, .buckets = buckets});
      for (const NodeId end : {arc.lo, arc.hi}) add_node(end, arc.born, arc.died);
    }
  }
  void add_isolated(NodeId node) { add_node(node, 0, kNeverDies); }

  // To be called once, after all records: entry e is version e. `persistence` has an entry for each version but 0.
  std::vector<VersionCounts> take(std::span<const double> persistence) {
    for (std::size_t version = 1; version < change_.size(); ++version) {
      const VersionCounts& before = change_[version - 1];
      change_[version].persistence = persistence[version - 1];
      change_[version].nodes += before.nodes;
      change_[version].arcs += before.arcs;
      change_[version].buckets += before.buckets;
    }
    return std::move(change_);
  }

 private:
  static constexpr std::uint32_t kNever = ~std::uint32_t{0};

  // Prefetch what add() accesses: nodes and versions; when these have arrived, the versions that the nodes name.
  void prefetch(const ArcVersion& arc) const {
    reeb::prefetch(&change_[arc.born]);
    for (const NodeId end : {arc.lo, arc.hi}) reeb::prefetch(&present_from_[end.value()]);
  }
  void prefetch_next(const ArcVersion& arc) const {
    for (const NodeId end : {arc.lo, arc.hi})
      if (const std::uint32_t from = present_from_[end.value()]; arc.born < from && from < change_.size())
        reeb::prefetch(&change_[from]);
  }

  // Unsigned numbers wrap around, so adding and subtracting cancel out.
  void arrives(std::uint32_t born, std::uint32_t died, const VersionCounts& what) {
    change_[born].nodes += what.nodes;
    change_[born].arcs += what.arcs;
    change_[born].buckets += what.buckets;
    if (died >= change_.size()) return;
    change_[died].nodes -= what.nodes;
    change_[died].arcs -= what.arcs;
    change_[died].buckets -= what.buckets;
  }

  // A node exists while any of its arcs does. Among the versions before `died`, it is known to exist from present_from_
  // on, if that is not later than `died`.
  void add_node(NodeId node, std::uint32_t born, std::uint32_t died) {
    std::uint32_t& from = present_from_[node.value()];
    if (born >= from) return;
    arrives(born, std::min(died, from), {.nodes = 1});
    from = born;
  }

  std::vector<std::uint32_t> present_from_;  // by node
  std::vector<VersionCounts> change_;        // by version: the change from the version before
};

}  // namespace reeb::ooc
