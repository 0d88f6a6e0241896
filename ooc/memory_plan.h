// How a run divides its memory budget among those who hold much (DESIGN.md 4, The budget).
#pragma once

#include <cstddef>
#include <cstdint>

#include "ooc/chunk_source.h"

namespace reeb::ooc {

struct MemoryPlan {
  std::uint64_t account_bytes = 0;       // what reservations may add up to
  std::uint64_t set_aside_bytes = 0;     // what the process needs besides
  std::uint64_t table_bytes = 0;         // last uses; as much again for a spooled mesh
  std::uint64_t segment_bytes = 0;       // settled arcs and nodes, a function
  std::uint64_t live_bytes = 0;          // live graph; a larger front is reordered
  unsigned threads = 1;
  ChunkSize chunk;

  // The largest live front that is glued as it comes.
  std::uint64_t most_live_vertices() const;
};

// `limit_bytes` is for the whole process; kUnlimited means half of this machine's memory. What the
// process needs for itself (code, stacks, windows of mapped input) is set aside first.
// THROWS: Error{kResource} if too little is left to do anything.
MemoryPlan plan_memory(std::uint64_t limit_bytes, unsigned threads, std::size_t functions,
                       std::size_t chunk_triangles);

}  // namespace reeb::ooc
