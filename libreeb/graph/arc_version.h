// Arcs of a graph in all its versions: each arc is a record with the versions in which it lives.
#pragma once

#include <cstdint>

#include "libreeb/base/ids.h"

namespace reeb {

inline constexpr std::uint32_t kNeverDies = ~std::uint32_t{0};

struct ArcVersion {
  NodeId lo, hi;
  std::uint32_t born = 0;           // the first version with the arc
  std::uint32_t died = kNeverDies;  // up to, not including, this version
  friend bool operator==(const ArcVersion&, const ArcVersion&) = default;
};

// The number of vertices that the step to this version dropped: they were on an arc that it removed, and there was no
// other arc to move them to.
struct DroppedVertices {
  std::uint32_t version = 0;
  std::uint64_t count = 0;
  friend bool operator==(const DroppedVertices&, const DroppedVertices&) = default;
};

}  // namespace reeb
