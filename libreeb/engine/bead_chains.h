// Chains of beads on the arcs of the live graph, each from the top down, in one pool.
//
// A bead is a settled node on the way of a long arc: one arc leads to it from above, one goes on below, and the others
// were written out. Every path passes it, and nothing can change it any more. So it needs no links of its own: 24
// bytes, and its position, instead of some 140 for a node, an arc and its references. Noise along a border is mostly
// such nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/state_stream.h"
#include "libreeb/base/sweep_key.h"
#include "libreeb/containers/growing_array.h"
#include "libreeb/containers/recycling_array.h"
#include "libreeb/graph/bucket_sums.h"
#include "libreeb/graph/settled_node.h"

namespace reeb {

class BeadChains {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = ~Index{0};

  struct Chain {
    Index lowest = kNone;  // `below` of it is the highest
    bool empty() const { return lowest == kNone; }
  };

  explicit BeadChains(bool track_positions) : track_positions_(track_positions) {}
  // A copy without positions and buckets.
  struct WithoutPositions {};
  BeadChains(const BeadChains& other, WithoutPositions) : track_positions_(false), beads_(other.beads_) {}

  // A chain of one bead. `buckets` are those of the arc below it.
  Chain make(const SweepKey& key, const Point& position, BucketLists::List buckets);
  // REQUIRES: the bead is in no chain that is used further, and nothing is in its list of buckets any more.
  void free(Index bead) { beads_.free(bead); }

  const SweepKey& key(Index bead) const { return beads_[bead].key; }
  Point position(Index bead) const { return track_positions_ ? positions_[bead] : Point{}; }
  BucketLists::List& buckets(Index bead) { return beads_[bead].buckets; }
  const BucketLists::List& buckets(Index bead) const { return beads_[bead].buckets; }

  Index highest(Chain chain) const { return chain.empty() ? kNone : beads_[chain.lowest].below; }
  Index below(Chain chain, Index bead) const { return bead == chain.lowest ? kNone : beads_[bead].below; }
  // Both as one. REQUIRES: the beads of `upper` are above those of `lower`.
  Chain joined(Chain upper, Chain lower);
  // Puts a bead below the others of a chain. The chain that it was in must not be used further, but what was read of it
  // before is right.
  void append(Chain& chain, Index bead);
  // The beads from this one down, or none for kNone. The others must be in no chain that is used further.
  Chain from(Chain chain, Index bead) {
    if (bead == kNone) return {};
    beads_[chain.lowest].below = bead;
    return chain;
  }
  // All but the lowest one. O(beads). The lowest one must be in no chain that is used further.
  Chain without_lowest(Chain chain);
  // Calls visit(bead) from above. `visit` may free the bead.
  template <class Visit>
  void visit(Chain chain, const Visit& visit) const {
    for (Index b = highest(chain); b != kNone;) {
      const Index next = below(chain, b);
      visit(b);
      b = next;
    }
  }

  std::size_t size() const { return beads_.size(); }  // free ones included
  std::size_t used() const { return beads_.used(); }
  std::size_t memory_bytes() const { return beads_.memory_bytes() + positions_.memory_bytes(); }
  // What it takes in addition for this many more.
  std::size_t growth_bytes(std::size_t beads) const;

  void save(StateWriter& out) const;
  // THROWS: DamagedState.
  void restore(StateReader& in);
  // Tells whether the chains that it is called for share no bead, are in order, and lie between these keys; at the end,
  // whether no bead is left.
  // THROWS: DamagedState.
  class RestoredCheck {
   public:
    explicit RestoredCheck(BeadChains& beads);
    void check(Chain chain, const SweepKey& lo, const SweepKey& hi);
    void end() const;

   private:
    const BeadChains& beads_;
    std::vector<bool> seen_;
  };

 private:
  struct Bead {
    SweepKey key;
    Index below;                // in its chain; while free, the next free bead
    BucketLists::List buckets;  // of the arc, from here to the bead below

    Index& next_free() { return below; }
  };

  bool track_positions_;
  RecyclingArray<Bead> beads_;
  GrowingArray<Point> positions_;  // one per bead, if tracked
};

}  // namespace reeb
