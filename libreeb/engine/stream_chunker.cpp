#include "libreeb/engine/stream_chunker.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb {

VertexId StreamChunker::add_vertex(std::span<const double> values, const Point& position) {
  const VertexId v(next_vertex_);
  for (const double value : values)
    if (!std::isfinite(value))
      throw Error(ErrorKind::kBadInput, "the value of vertex " + std::to_string(v.value()) + " is not finite",
                  "give every vertex a finite function value");
  ++next_vertex_;
  std::uint32_t slot;
  if (free_slots_.empty()) {
    slot = static_cast<std::uint32_t>(local_.size());
    local_.push_back(kNone);
    state_.push_back(State::kFree);
    slot_vertices_.emplace_back();
    slot_values_.resize(slot_values_.size() + functions_);
    if (track_positions_) slot_positions_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  local_[slot] = kNone;
  state_[slot] = State::kUnused;
  slot_vertices_[slot] = v;
  for (std::size_t k = 0; k < functions_; ++k)
    slot_values_[slot * functions_ + k] = values[k] + 0.0;  // -0.0 becomes 0.0
  if (track_positions_) slot_positions_[slot] = position;
  slot_of_.find_or_insert(v.value(), slot);
  return v;
}

std::uint32_t StreamChunker::slot_of(VertexId v, const char* use) const {
  const std::uint32_t slot = slot_of_.find(v.value());
  if (slot != FlatMap::kNone) return slot;
  const bool known = v.value() < next_vertex_;
  throw Error(ErrorKind::kBadInput,
              std::string(use) + " vertex " + std::to_string(v.value()) +
                  (known ? ", which was already finalized"
                         : ", but only " + count_of(next_vertex_, "vertex") + (next_vertex_ == 1 ? " was" : " were") +
                               " added"),
              known ? "finalize a vertex once, after the last simplex that uses it"
                    : "add every vertex before the first simplex that uses it");
}

std::uint32_t StreamChunker::add_to_chunk(VertexId v, std::uint32_t slot) {
  local_[slot] = static_cast<std::uint32_t>(chunk_.vertex_count());
  chunk_.ids.push_back(v);
  chunk_.uses.push_back(state_[slot] == State::kTaken ? kUsedEarlier : kUsedHereOnly);
  if (state_[slot] == State::kUnused) {
    state_[slot] = State::kInChunk;
    ++used_vertices_;
  }
  if (track_positions_) chunk_.positions.push_back(slot_positions_[slot]);
  for (std::size_t k = 0; k < functions_; ++k) values_[k].push_back(slot_values_[slot * functions_ + k]);
  slot_of_local_.push_back(slot);
  return local_[slot];
}

void StreamChunker::add_simplex(std::span<const VertexId> corners) {
  corners_.assign(corners.begin(), corners.end());
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  for (const VertexId v : corners_) slot_of(v, "a simplex names");
  if (corners_.size() < 2) return;  // a vertex needs no simplex
  deciding_.of_simplex(corners_, [this](VertexId a, VertexId b, VertexId c) { add_triangle(a, b, c); });
}

void StreamChunker::add_triangle(VertexId a, VertexId b, VertexId c) {
  for (const VertexId v : {a, b, c}) chunk_.corners.push_back(bring_in(v, slot_of_.find(v.value())));
}

void StreamChunker::finalize(VertexId v) { finalize(v, slot_of(v, "finalize() names")); }

void StreamChunker::finalize_all() {
  for (std::uint64_t v = 0; v < next_vertex_ && slot_of_.size() != 0; ++v)
    if (const std::uint32_t slot = slot_of_.find(v); slot != FlatMap::kNone) finalize(VertexId(v), slot);
}

// A vertex that is not in the chunk is added as a loose vertex, so that gluing the chunk completes it.
void StreamChunker::finalize(VertexId v, std::uint32_t slot) {
  const std::uint32_t local = bring_in(v, slot);
  slot_of_local_[local] = kNone;
  ++final_in_chunk_;
  ++final_vertices_;
  state_[slot] = State::kFree;
  slot_of_.erase(v.value());
  free_slots_.push_back(slot);
}

void StreamChunker::take(Chunk& chunk, std::vector<std::vector<double>>& values) {
  for (std::size_t local = 0; local < slot_of_local_.size(); ++local) {
    const std::uint32_t slot = slot_of_local_[local];
    if (slot == kNone) continue;
    chunk_.uses[local] |= kUsedLater;
    state_[slot] = State::kTaken;
    local_[slot] = kNone;
  }
  std::swap(chunk, chunk_);
  std::swap(values, values_);
  start_chunk();
}

void StreamChunker::start_chunk() {
  chunk_.clear();
  values_.resize(functions_);
  for (auto& column : values_) column.clear();
  slot_of_local_.clear();
  final_in_chunk_ = 0;
}

void StreamChunker::take_final(Chunk& chunk, std::vector<std::vector<double>>& values) {
  const Chunk whole = std::move(chunk_);
  const std::vector<std::vector<double>> whole_values = std::move(values_);
  const std::vector<std::uint32_t> slots = std::move(slot_of_local_);
  start_chunk();
  chunk.clear();
  values.resize(functions_);
  for (auto& column : values) column.clear();

  // The numbers of vertices in the chunk that leaves, which all final ones are in.
  std::vector<std::uint32_t> leaving(slots.size(), kNone);
  const auto leave = [&](std::uint32_t local) {
    if (leaving[local] != kNone) return;
    const std::uint32_t slot = slots[local];
    leaving[local] = static_cast<std::uint32_t>(chunk.vertex_count());
    chunk.ids.push_back(whole.ids[local]);
    chunk.uses.push_back(static_cast<std::uint8_t>(whole.uses[local] | (slot == kNone ? 0 : kUsedLater)));
    if (track_positions_) chunk.positions.push_back(whole.positions[local]);
    for (std::size_t k = 0; k < functions_; ++k) values[k].push_back(whole_values[k][local]);
    if (slot != kNone) state_[slot] = State::kTaken;
  };
  for (std::uint32_t local = 0; local < slots.size(); ++local) {
    if (slots[local] == kNone)
      leave(local);
    else
      local_[slots[local]] = kNone;
  }
  const auto each_triangle = [&](const auto& visit) {
    for (std::size_t i = 0; i < whole.corners.size(); i += 3) {
      const auto corners = std::span(whole.corners).subspan(i, 3);
      visit(corners, std::any_of(corners.begin(), corners.end(), [&](std::uint32_t c) { return slots[c] == kNone; }));
    }
  };
  each_triangle([&](std::span<const std::uint32_t> corners, bool has_final) {
    if (!has_final) return;
    for (const std::uint32_t c : corners) {
      leave(c);
      chunk.corners.push_back(leaving[c]);
    }
  });
  // Only now is it known which vertices of the triangles that stay are also in the chunk that leaves.
  each_triangle([&](std::span<const std::uint32_t> corners, bool has_final) {
    if (has_final) return;
    for (const std::uint32_t c : corners) chunk_.corners.push_back(bring_in(whole.ids[c], slots[c]));
  });
}

std::size_t StreamChunker::slot_bytes() const {
  return slot_of_.memory_bytes() + state_.capacity() + 8 * slot_vertices_.capacity() +
         4 * (local_.capacity() + free_slots_.capacity()) + 8 * slot_values_.capacity() +
         slot_positions_.capacity() * sizeof(Point) + deciding_.memory_bytes();
}

std::size_t StreamChunker::memory_bytes_with(std::size_t more_vertices) const {
  const std::size_t room = local_.capacity() - local_.size() + free_slots_.size();
  if (more_vertices <= room) return memory_bytes();
  return memory_bytes() + slot_bytes() + slot_positions_.capacity() * sizeof(Point) / 2;
}

std::size_t StreamChunker::memory_bytes() const {
  std::size_t bytes = slot_bytes();
  bytes += 8 * chunk_.ids.capacity() + chunk_.uses.capacity() + sizeof(Point) * chunk_.positions.capacity() +
           4 * (chunk_.corners.capacity() + slot_of_local_.capacity());
  for (const auto& column : values_) bytes += 8 * column.capacity();
  return bytes;
}

}  // namespace reeb
