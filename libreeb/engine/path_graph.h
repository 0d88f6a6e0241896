// Nodes, arcs, and paths of mesh edges over them, linked with each other.
//
// A path is a chain of references, one on each arc of a monotone chain, from the top down; each arc lists the
// references on it. A node lists its arcs, up and down.
//
// Everything is a 32-bit index into flat arrays with free lists; a reference is 16 bytes. The functions keep the links
// consistent; what is done with the graph is up to its owner (live_graph.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libreeb/base/state_stream.h"
#include "libreeb/base/sweep_key.h"
#include "libreeb/containers/recycling_array.h"
#include "libreeb/engine/bead_chains.h"
#include "libreeb/graph/direction.h"

namespace reeb {

struct PathGraph {
  using Index = std::uint32_t;
  static constexpr Index kNone = ~Index{0};

  // Incomplete: the node's vertex can get further simplices. Complete: it cannot. Settled: in addition, the node is
  // certain to be in the final graph, unless noise removal takes it away.
  enum class State : std::uint8_t { kIncomplete, kComplete, kSettled };

  struct Node {
    SweepKey key;
    // The lists of its arcs and their lengths, indexed by which end of the arc is at this node: arcs up from the node
    // have their lower end here, so they are in the list first_at[kDown].
    std::array<Index, 2> first_at;
    std::array<std::uint32_t, 2> degree_at;
    std::uint32_t referenced_arcs;  // arcs at this node that have references
    State state;
    bool intact : 1;  // no arc of it was written out
    bool queued : 1;  // to be examined by LiveGraph::tidy()
    bool used : 1;
    bool near_noise : 1;            // it has or had an arc that is noise or might become noise
    bool far_down : 1, far_up : 1;  // as in a fragment that has the node

    // Its first arc in direction d, and the number of arcs there.
    Index first(Direction d) const { return first_at[opposite(d)]; }
    std::uint32_t degree(Direction d) const { return degree_at[opposite(d)]; }
    std::uint32_t degree() const { return degree_at[kDown] + degree_at[kUp]; }
    Index& next_free() { return first_at[kDown]; }
  };
  // An arc's neighbours in a list.
  struct Links {
    Index next, prev;
  };
  struct Arc {
    std::array<Index, 2> end;    // by side; end[kDown] == kNone: free
    std::array<Links, 2> links;  // by side: among the arcs that have the same end there
    Index first_reference;
    std::uint32_t references;
    BeadChains::Chain beads;

    Index lo() const { return end[kDown]; }
    Index hi() const { return end[kUp]; }
    bool is_free() const { return lo() == kNone; }
    // The next arc in direction d of the node that both leave in that direction.
    Index next(Direction d) const { return links[opposite(d)].next; }
    Index& next_free() { return links[kDown].next; }
  };
  struct Reference {
    Index arc;
    Index next, prev;  // on the arc; next also links free references
    Index down;        // the next one on the path

    Index& next_free() { return next; }
  };

  // Makes the node the arc's end on this side, or no longer.
  void attach(Index arc, Direction side, Index node);
  void detach(Index arc, Direction side);
  void detach(Index arc) {
    detach(arc, kDown);
    detach(arc, kUp);
  }
  // REQUIRES: the arc is detached, and no reference is on it; the node has no arcs.
  void free_arc(Index arc);
  void free_node(Index node);
  // Puts a reference on an arc, or takes it away. Neither counts the arc at its ends (referenced_arcs).
  void link(Index reference, Index arc);
  void unlink(Index reference);

  double length(Index arc) const { return nodes[arcs[arc].hi()].key.value - nodes[arcs[arc].lo()].key.value; }
  // Whether the path leads from `hi` down to `lo`.
  bool has_ends(Index top, Index lo, Index hi) const;

  void save(StateWriter& out) const;
  void restore(StateReader& in);
  // For what was restored, once all indices are known to be in range.
  // THROWS: DamagedState unless each node lists its arcs, and each reference is below at most one other, on an arc that
  //         begins where the arc of the other ends. The second returns, by reference, whether it is the top of a path.
  void check_restored_lists() const;
  std::vector<bool> check_restored_paths();

  RecyclingArray<Node> nodes;
  RecyclingArray<Arc> arcs;
  RecyclingArray<Reference> references;
};

}  // namespace reeb
