// Numbers the vertices of a chunk in order of first appearance.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/containers/flat_map.h"

namespace reeb::ooc {

// The numbers are in a table indexed by the low bits of the vertex id, so that near ids are near in memory: a coherent
// stream needs that. A vertex whose entry is taken goes to a hash map instead.
//
// Nothing is cleared between chunks: an entry is taken if the vertex that has its number in this chunk belongs to that
// entry (a sparse set, Briggs and Torczon 1993).
// TIME: O(1) per look-up, about 1 ns if the ids of a chunk are near each other.
class LocalNumbers {
 public:
  // Starts a new chunk, whose vertices are appended to `ids`. Look-ups are fastest with up to `expected` vertices; more
  // are allowed. REQUIRES: ids is empty.
  void start(std::vector<VertexId>& ids, std::size_t expected) {
    ids_ = &ids;
    elsewhere_.clear();
    const std::size_t size = std::bit_ceil(expected + 1);
    if (place_.size() < size) place_.resize(size);
  }

  // Sets numbers[i] to the number of vertices[i]. REQUIRES: both have the same length.
  void number(std::span<const VertexId> vertices, std::span<std::uint32_t> numbers) {
    const std::size_t mask = place_.size() - 1;
    std::uint32_t* const place = place_.data();
    const VertexId* ids = ids_->data();
    std::size_t known = ids_->size();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const VertexId vertex = vertices[i];
      std::uint32_t& here = place[vertex.value() & mask];
      std::uint32_t number = here;
      if (number >= known || ids[number] != vertex) {
        number = number_other(vertex, here, mask);
        ids = ids_->data();
        known = ids_->size();
      }
      numbers[i] = number;
    }
  }

  std::size_t memory_bytes() const { return place_.capacity() * 4 + elsewhere_.memory_bytes(); }

 private:
  // Of a vertex that is not the one at its place.
  std::uint32_t number_other(VertexId vertex, std::uint32_t& here, std::size_t mask) {
    const auto fresh = static_cast<std::uint32_t>(ids_->size());
    const bool is_taken = here < fresh && (((*ids_)[here].value() ^ vertex.value()) & mask) == 0;
    const std::uint32_t number = is_taken ? elsewhere_.find_or_insert(vertex.value(), fresh) : here = fresh;
    if (number == fresh) ids_->push_back(vertex);
    return number;
  }

  std::vector<VertexId>* ids_ = nullptr;
  std::vector<std::uint32_t> place_;  // a power of two of them
  FlatMap elsewhere_;
};

}  // namespace reeb::ooc
