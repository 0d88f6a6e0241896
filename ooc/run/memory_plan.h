// How a run divides its memory budget among those who hold much (DESIGN.md 4, The budget).
#pragma once

#include <cstddef>
#include <cstdint>

#include "ooc/chunks/chunk_source.h"

namespace reeb::ooc {

// What a run asks of its memory.
struct MemoryRequest {
  std::uint64_t limit_bytes = 0;  // for the whole process; kUnlimited: half of this machine's memory
  unsigned threads = 1;
  std::size_t functions = 1;
  std::size_t chunk_triangles = 0, stretch_triangles = 0;  // a user's choice; 0: none
  bool in_place = false;                                   // the mesh is looked up in its own file, not spooled
  bool embeds = true;
  bool denoises = false;
};

// What is known of a mesh before it is glued.
struct FrontNeeds {
  std::uint64_t vertices = 0;        // in all
  std::uint64_t live_vertices = 0;   // at once, at most
  std::uint64_t function_bytes = 0;  // that functions keep for looking up
};

class MemoryPlan {
 public:
  std::uint64_t account_bytes = 0;       // what reservations may add up to
  std::uint64_t set_aside_bytes = 0;     // what the process needs besides
  std::uint64_t table_bytes = 0;         // last uses; as much again for a spooled mesh
  std::uint64_t segment_bytes = 0;       // settled arcs and nodes, a function
  std::uint64_t most_segment_bytes = 0;  // the same where they are many
  unsigned threads = 1;
  ChunkSize chunk;

  // Whether the live graphs will likely fit beside chunks of a useful size.
  bool fits(const FrontNeeds& needs) const;
  // Whether they would not fit even if the functions were smooth.
  bool exceeds(const FrontNeeds& needs) const;
  // The largest front of a mesh of which nothing is known that will likely fit.
  std::uint64_t most_live_vertices() const;
  // A limit for the whole process within which they fit.
  std::uint64_t needed_bytes(const FrontNeeds& needs) const;
  // Gives chunks what the live graphs leave. Depends on nothing but the request and the needs, so
  // that a run that goes on cuts the same chunks.
  void share_out(const FrontNeeds& needs);

 private:
  friend MemoryPlan plan_memory(const MemoryRequest& request);
  std::uint64_t taken_bytes(const FrontNeeds& needs) const;
  std::uint64_t live_room(const FrontNeeds& needs) const;
  bool allows_threads() const;
  std::uint64_t triangle_bytes() const;
  void size_chunks(std::uint64_t bytes, std::size_t most_triangles);

  MemoryRequest request_;
  std::uint64_t vertex_bytes_ = 0;        // of the live graphs, likely, a live vertex
  std::uint64_t least_vertex_bytes_ = 0;  // the same for smooth functions
};

// What the process needs for itself (code, stacks, windows of mapped input) is set aside first.
// THROWS: Error{kResource} if too little is left to do anything.
MemoryPlan plan_memory(const MemoryRequest& request);

}  // namespace reeb::ooc
