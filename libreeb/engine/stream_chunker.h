// Cuts a stream of vertices, simplices and finalizations into chunks (docs/SEMANTICS.md, Input).
//
// MEMORY: the vertices that are not final yet, and the chunk so far.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/containers/flat_map.h"
#include "libreeb/port/deciding_triangles.h"
#include "libreeb/sweep/chunk.h"

namespace reeb {

class StreamChunker {
 public:
  // `functions`: the number of values of a vertex.
  StreamChunker(std::size_t functions, bool track_positions)
      : functions_(functions), track_positions_(track_positions), values_(functions) {}

  // Adds the next vertex and returns its index: 0, 1, 2, ...
  // THROWS: Error{kBadInput} if a value is not finite.
  VertexId add_vertex(std::span<const double> values, const Point& position);

  // Says that no vertex has an index below `next` which was not given yet.
  void skip_to(VertexId next) { next_vertex_ = std::max(next_vertex_, next.value()); }

  // Adds the triangles that decide of the simplex with this set of corners (repeats are ignored), of any dimension.
  // THROWS: Error{kBadInput} if a corner was not added or was finalized.
  void add_simplex(std::span<const VertexId> corners);

  // THROWS: Error{kBadInput} if `v` was not added or was finalized before.
  void finalize(VertexId v);
  void finalize_all();

  // The triangles of the chunk so far, or its vertices, whichever are more.
  std::size_t chunk_size() const { return std::max(chunk_.triangle_count(), chunk_.vertex_count()); }
  // The final ones among its vertices.
  std::size_t final_in_chunk() const { return final_in_chunk_; }
  // The chunk so far, as if it were the last one: no vertex is marked kUsedLater. One array of values per function.
  const Chunk& chunk() const { return chunk_; }
  const std::vector<std::vector<double>>& values() const { return values_; }

  // Moves the chunk so far out, with its values, and starts the next.
  void take(Chunk& chunk, std::vector<std::vector<double>>& values);
  // Moves out only the triangles with a final vertex, and the final vertices. The others stay in the chunk so far.
  // O(chunk so far).
  void take_final(Chunk& chunk, std::vector<std::vector<double>>& values);

  // Calls visit(values, vertex) for the vertices that no simplex has used yet and that are not final. No chunk has
  // them, and neither has the chunk so far.
  template <class Visit>
  void for_each_unused(const Visit& visit) const {
    for (std::size_t slot = 0; slot < state_.size(); ++slot)
      if (state_[slot] == State::kUnused)
        visit(std::span(slot_values_).subspan(slot * functions_, functions_), slot_vertices_[slot]);
  }

  // The index of the next vertex.
  std::uint64_t vertex_bound() const { return next_vertex_; }
  std::size_t active_vertices() const { return slot_of_.size(); }
  // How many vertices came into a chunk so far, and how many were finalized.
  std::uint64_t used_vertices() const { return used_vertices_; }
  std::uint64_t final_vertices() const { return final_vertices_; }
  std::size_t memory_bytes() const;  // of both
  // The most that they take while this many vertices are added: arrays that grow are copied.
  std::size_t memory_bytes_with(std::size_t more_vertices) const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  // The state of a slot: its vertex is in no chunk yet, only in the chunk so far, or in a chunk that was taken. A
  // vertex does not count as used when it arrives: otherwise all edges of a mesh whose vertices come first would be
  // shared.
  enum class State : std::uint8_t { kFree, kUnused, kInChunk, kTaken };

  std::uint32_t slot_of(VertexId v, const char* use) const;
  // The vertex in the chunk, added to it if it is not there yet.
  std::uint32_t bring_in(VertexId v, std::uint32_t slot) {
    return local_[slot] != kNone ? local_[slot] : add_to_chunk(v, slot);
  }
  std::uint32_t add_to_chunk(VertexId v, std::uint32_t slot);
  void add_triangle(VertexId a, VertexId b, VertexId c);
  void finalize(VertexId v, std::uint32_t slot);
  void start_chunk();
  std::size_t slot_bytes() const;

  std::size_t functions_;
  bool track_positions_;
  std::uint64_t next_vertex_ = 0;

  // Vertices that are not final, by slot.
  FlatMap slot_of_;
  std::vector<State> state_;
  std::vector<VertexId> slot_vertices_;
  std::vector<std::uint32_t> local_;  // in the chunk, or kNone
  std::vector<double> slot_values_;   // functions_ per slot
  std::vector<Point> slot_positions_;
  std::vector<std::uint32_t> free_slots_;

  Chunk chunk_;
  std::vector<std::vector<double>> values_;
  std::vector<std::uint32_t> slot_of_local_;  // kNone once the vertex is final
  std::size_t final_in_chunk_ = 0;
  std::uint64_t used_vertices_ = 0, final_vertices_ = 0;
  DecidingTriangles deciding_;
  std::vector<VertexId> corners_;
};

}  // namespace reeb
