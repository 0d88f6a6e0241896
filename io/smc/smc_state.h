// The common state of encoder and decoder of SMC files at any moment of the stream: the active vertices, the open edges
// between them, the last triangle, and the models of the connectivity.
//
// All of it follows from the triangles so far. Every order in it (of active vertices, of the edges of a vertex) is part
// of the file format.
// MEMORY: follows the active vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "io/smc/adaptive_model.h"
#include "io/smc/smc_positions.h"

namespace reeb::io {

inline constexpr std::uint32_t kNone = ~0u;

// START a component, ADD a vertex at an open edge, JOIN an active vertex to an open edge, FILL between two open edges,
// END between three. In the file FILL and END have the same symbol.
enum class SmcOperation : std::uint8_t { kStart, kAdd, kJoin, kFill, kEnd };
inline constexpr std::size_t kSmcOperations = 5;
inline constexpr std::uint32_t kFillSymbol = 3;
// Symbols for "not in the cache": for a start corner, an edge, a pair of edges.
inline constexpr std::uint32_t kStartEscape = 3, kEdgeEscape = 6, kPairEscape = 9;
inline constexpr std::uint32_t kEndOfStream = 4;  // in place of the number of old corners, in version 3

struct SmcModels {
  explicit SmcModels(unsigned version);

  AdaptiveModel done{2, kSmallModel};
  std::vector<AdaptiveModel> operation;    // by previous operation
  AdaptiveModel old_corners;               // of a start
  std::vector<AdaptiveModel> start_cache;  // by corner
  std::vector<AdaptiveModel> edge_cache;   // by previous operation
  std::vector<AdaptiveModel> pair_cache;   // by previous operation
  // By number of open edges and of triangles at the corner.
  AdaptiveModel& final_at(std::uint32_t edges, std::uint32_t uses) {
    return finals_[std::min(edges, 3u) * kMaxUses + std::min(uses, kMaxUses) - 1];
  }

 private:
  static constexpr std::uint32_t kMaxUses = 14;
  std::vector<AdaptiveModel> finals_;
};

// Lists of numbers in one array. Capacities are powers of two; released parts are reused by lists of the same capacity.
class NumberLists {
 public:
  struct List {
    std::uint32_t begin = kNone, size = 0, log_capacity = 0;
  };

  std::uint32_t at(const List& list, std::uint32_t i) const { return numbers_[list.begin + i]; }
  void append(List& list, std::uint32_t number) {
    if (list.begin == kNone || list.size == 1u << list.log_capacity) grow(list);
    numbers_[list.begin + list.size++] = number;
  }
  // Removes the first occurrence; the last entry takes its place. REQUIRES: the list contains `number`.
  void remove(List& list, std::uint32_t number) {
    std::uint32_t i = 0;
    while (numbers_[list.begin + i] != number) ++i;
    numbers_[list.begin + i] = numbers_[list.begin + --list.size];
  }
  void release(List& list);
  std::uint64_t memory_bytes() const;

 private:
  static constexpr std::uint32_t kFirstLog = 3;
  void grow(List& list);
  std::uint32_t take(std::uint32_t log_capacity);

  std::vector<std::uint32_t> numbers_;
  std::array<std::vector<std::uint32_t>, 32> free_;  // by log_capacity
};

struct SmcVertex {
  std::uint32_t index;  // in the stream; kNone: the slot is free
  std::uint32_t place;  // in the order of active vertices, counted from its first entry since the start
  std::uint32_t uses;   // triangles so far
  NumberLists::List edges;
  CodedPosition position;
};

// Directed from `origin` to `target`, as in the triangle that opened it.
struct SmcEdge {
  std::uint32_t origin, target;  // slots of vertices
  CodedPosition apex;            // third corner of that triangle
};

// A vertex of the last triangle. It can be final by now, and its slot can have another vertex.
struct SmcCached {
  std::uint32_t slot = kNone, index = kNone;
};

class SmcState {
 public:
  // A triangle about to be coded: slots of its corners, and for each side i -> i+1 the open edge
  // that it closes, or kNone.
  struct Triangle {
    std::array<std::uint32_t, 3> corners{kNone, kNone, kNone};
    std::array<std::uint32_t, 3> edges{kNone, kNone, kNone};
  };

  // Returns a new slot, which is not yet in the order of active vertices.
  std::uint32_t create_vertex(std::uint32_t index, const CodedPosition& position);
  void append_active(std::uint32_t slot);
  // Removes the vertex and its open edges. REQUIRES: it is active.
  void finalize(std::uint32_t slot);
  // Releases the slot of a vertex that never became active.
  void drop_vertex(std::uint32_t slot) { release(slot); }

  SmcVertex& vertex(std::uint32_t slot) { return vertices_[slot]; }
  const SmcVertex& vertex(std::uint32_t slot) const { return vertices_[slot]; }
  const SmcEdge& edge(std::uint32_t id) const { return edges_[id]; }
  std::uint32_t edge_at(std::uint32_t slot, std::uint32_t i) const { return lists_.at(vertices_[slot].edges, i); }

  std::uint32_t active_count() const { return active_count_; }
  std::uint32_t open_edges() const { return open_edges_; }
  // The position of an active vertex in the order, from 0; and the vertex at a position.
  std::uint32_t place_of(std::uint32_t slot) const { return vertices_[slot].place - first_place_; }
  std::uint32_t active_at(std::uint32_t place) const { return active_[(first_place_ + place) & (active_.size() - 1)]; }

  // The slot of cache entry `i`; kNone if it is empty or final.
  std::uint32_t cached(std::size_t i) const {
    const SmcCached& entry = cache_[i];
    return entry.slot != kNone && vertices_[entry.slot].index == entry.index ? entry.slot : kNone;
  }
  // The first cache entry with this vertex, or 3.
  std::uint32_t cache_entry(std::uint32_t slot) const {
    for (std::uint32_t i = 0; i < 3; ++i)
      if (cached(i) == slot) return i;
    return 3;
  }
  SmcOperation previous() const { return previous_; }
  std::size_t context() const { return static_cast<std::size_t>(previous_); }

  // The number of edges at `slot` that have it as their target (or origin).
  std::uint32_t count_edges(std::uint32_t slot, bool incoming) const;
  // The edge with rank `rank` among these; and the rank of an edge.
  std::uint32_t pick_edge(std::uint32_t slot, bool incoming, std::uint32_t rank) const;
  std::uint32_t rank_of_edge(std::uint32_t slot, bool incoming, std::uint32_t edge) const;
  // The first edge at `slot` whose origin (target) is the vertex `end`, or kNone.
  std::uint32_t find_edge_from(std::uint32_t slot, std::uint32_t end) const;
  std::uint32_t find_edge_to(std::uint32_t slot, std::uint32_t end) const;

  // Makes this the last triangle: counts its uses, closes and opens edges.
  void apply(const Triangle& triangle, SmcOperation operation);

  std::uint64_t memory_bytes() const;

 private:
  void open_edge(std::uint32_t origin, std::uint32_t target, const CodedPosition& apex);
  void close_edge(std::uint32_t id);
  void remove_active(std::uint32_t slot);
  void grow_active();
  void release(std::uint32_t slot);

  std::vector<SmcVertex> vertices_;
  std::vector<std::uint32_t> free_vertices_;
  std::vector<SmcEdge> edges_;
  std::vector<std::uint32_t> free_edges_;
  NumberLists lists_;
  std::vector<std::uint32_t> active_;  // ring of slots, a power of two long
  std::uint32_t first_place_ = 0, active_count_ = 0;
  std::uint32_t open_edges_ = 0;
  std::array<SmcCached, 3> cache_;
  SmcOperation previous_ = SmcOperation::kStart;
};

}  // namespace reeb::io
