// Strong integer ids: a whole-mesh vertex and a vertex of one chunk never mix.
//
// An id is its number and nothing else: trivially copyable, ordered by number, hashed by value().
// Converting between two kinds is always a named function of the table that knows the mapping.
// Ids that only the engine uses are in libreeb/sweep/chunk.h.
#pragma once

#include <compare>
#include <concepts>
#include <cstdint>

namespace reeb {

template <class Tag, class Rep>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(Rep value) : value_(value) {}
  // An id that no object has.
  static constexpr Id none() { return Id(static_cast<Rep>(~Rep{0})); }

  constexpr Rep value() const { return value_; }
  constexpr Id& operator++() {
    ++value_;
    return *this;
  }
  friend constexpr auto operator<=>(const Id&, const Id&) = default;

 private:
  Rep value_ = 0;
};

// A vertex of the input mesh: its order of appearance, from 0.
using VertexId = Id<struct VertexTag, std::uint64_t>;
// A node of a Reeb graph in memory: its rank in the total order of the graph's nodes.
using NodeId = Id<struct NodeTag, std::uint32_t>;
// An arc of a Reeb graph in memory: its index in the canonical order of arcs.
using ArcId = Id<struct ArcTag, std::uint32_t>;

static_assert(!std::equality_comparable_with<VertexId, NodeId> && !std::equality_comparable_with<NodeId, ArcId>);
static_assert(!std::convertible_to<NodeId, ArcId> && !std::convertible_to<std::uint32_t, NodeId>);
static_assert(sizeof(NodeId) == sizeof(std::uint32_t));

}  // namespace reeb
