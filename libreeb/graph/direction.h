// Up and down along the function. Code that takes a Direction serves both, since they mirror each other.
#pragma once

#include <cstdint>

#include "libreeb/base/ids.h"

namespace reeb {

// Which way along f. Also the index of an arc's end on that side.
enum Direction : std::uint32_t { kDown = 0, kUp = 1 };

constexpr Direction opposite(Direction d) { return d == kUp ? kDown : kUp; }

// A key that grows with each step in direction d, for nodes that are numbered by rank.
constexpr std::uint32_t along(Direction d, std::uint32_t node) { return d == kUp ? node : ~node; }
template <class Tag>
constexpr std::uint32_t along(Direction d, Id<Tag, std::uint32_t> node) {
  return along(d, node.value());
}

}  // namespace reeb
