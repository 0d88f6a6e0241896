// How a run divides its memory budget among its large data structures (docs/ARCHITECTURE.md).
#pragma once

#include <cstddef>
#include <cstdint>

#include "ooc/chunks/chunk_source.h"

namespace reeb::ooc {

// What the memory of a run depends on.
struct MemoryRequest {
  std::uint64_t limit_bytes = 0;  // for the whole process; kUnlimited: half of this machine's memory
  unsigned threads = 1;
  std::size_t functions = 1;
  std::size_t chunk_triangles = 0, stretch_triangles = 0;  // a user's choice; 0: none
  std::uint64_t reader_bytes = 0;                          // what unpacking the input holds
  bool in_place = false;                                   // the mesh is looked up in its own file, not spooled
  bool embeds = true;
  bool denoises = false;
};

// What is known about a mesh before it is glued.
struct FrontNeeds {
  std::uint64_t vertices = 0;        // in all
  std::uint64_t live_vertices = 0;   // at once, at most
  std::uint64_t function_bytes = 0;  // of values that functions keep for looking up
  std::uint64_t order_bytes = 0;     // of the list of pieces, if these are visited in another order
};

class MemoryPlan {
 public:
  std::uint64_t budget_bytes = 0;        // the most that reservations may add up to
  std::uint64_t set_aside_bytes = 0;     // what the process needs in addition
  std::uint64_t table_bytes = 0;         // for last uses; the same again for a spooled mesh
  std::uint64_t segment_bytes = 0;       // per function, for settled arcs and nodes
  std::uint64_t most_segment_bytes = 0;  // the same where there are many
  unsigned threads = 1;
  ChunkSize chunk;

  // Whether the live graphs will likely fit together with chunks of a useful size.
  bool fits(const FrontNeeds& needs) const;
  // Whether they would not fit even if the functions were smooth.
  bool exceeds(const FrontNeeds& needs) const;
  // The largest front that will likely fit, for a mesh of which nothing is known.
  std::uint64_t most_live_vertices() const;
  // A memory limit for the whole process with which they fit.
  std::uint64_t needed_bytes(const FrontNeeds& needs) const;
  // Triangles of a box of a volume. A vertex of it has six times as many as one of a surface, so a box as large as a
  // usual chunk has half of its vertices on its faces, and gluing takes most of the time. Where memory is free, boxes
  // are up to four times as large.
  std::size_t box_triangles() const;
  // Gives chunks the memory that the live graphs leave. The result depends on the request and the needs only, so a
  // resumed run cuts the same chunks.
  void share_out(const FrontNeeds& needs);

 private:
  friend MemoryPlan plan_memory(const MemoryRequest& request);
  std::uint64_t taken_bytes(const FrontNeeds& needs) const;
  std::uint64_t live_room(const FrontNeeds& needs) const;
  bool allows_threads() const;
  std::uint64_t triangle_bytes() const;
  void size_chunks(std::uint64_t bytes, std::size_t most_triangles);

  MemoryRequest request_;
  std::uint64_t vertex_bytes_ = 0;        // of the live graphs, likely, per live vertex
  std::uint64_t least_vertex_bytes_ = 0;  // the same for smooth functions
};

// First sets aside what the process itself needs (code, stacks, windows of mapped input).
// THROWS: Error{kResource} if too little is left to work with.
MemoryPlan plan_memory(const MemoryRequest& request);

}  // namespace reeb::ooc
