// Up and down along the function: what holds for one direction holds, mirrored, for the other.
#pragma once

#include <cstdint>

namespace reeb {

// Which way along f. Also the index of an arc's end on that side.
enum Direction : std::uint32_t { kDown = 0, kUp = 1 };

constexpr Direction opposite(Direction d) { return d == kUp ? kDown : kUp; }

// Grows with each step in direction d: the key under which nodes are compared that are numbered by
// rank.
constexpr std::uint32_t along(Direction d, std::uint32_t node) { return d == kUp ? node : ~node; }

}  // namespace reeb
