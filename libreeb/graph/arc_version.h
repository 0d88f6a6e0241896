// Arcs of a partially persistent graph: each is a record with the versions in which it lives.
#pragma once

#include <cstdint>

#include "libreeb/base/ids.h"

namespace reeb {

inline constexpr std::uint32_t kNeverDies = ~std::uint32_t{0};

struct ArcVersion {
  NodeId lo, hi;
  std::uint32_t born = 0;           // present from this version on
  std::uint32_t died = kNeverDies;  // up to, not including, this version
  friend bool operator==(const ArcVersion&, const ArcVersion&) = default;
};

// Vertices of an arc that was taken away in making this version, with no arc beside it to hold them.
struct DroppedVertices {
  std::uint32_t version = 0;
  std::uint64_t count = 0;
  friend bool operator==(const DroppedVertices&, const DroppedVertices&) = default;
};

}  // namespace reeb
