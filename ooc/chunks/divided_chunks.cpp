#include "ooc/chunks/divided_chunks.h"

#include <algorithm>
#include <utility>

namespace reeb::ooc {

bool DividedChunks::next(WorkItem& item) {
  if (next_patch_ == patches_.patch_count()) {
    if (!stretches_.next(stretch_)) return false;
    if (is_small(stretch_.chunk)) {
      take_whole(item);
      return true;
    }
    divide();
  }
  take_patch(item);
  return true;
}

bool DividedChunks::is_small(const Chunk& chunk) const {
  const std::size_t most = size_.first + size_.first / 4;  // the last batch of a stretch can exceed its size
  if (chunk.triangle_count() > most) return false;
  return chunk.vertex_count() <= size_.first_vertices || chunk.triangle_count() <= size_.patch;
}

// Patches of a stretch with many vertices a triangle have about half of the vertices that a whole chunk may have.
std::size_t DividedChunks::patch_size() const {
  const auto triangles = static_cast<double>(stretch_.chunk.triangle_count());
  const double most =
      triangles / static_cast<double>(stretch_.chunk.vertex_count()) * (static_cast<double>(size_.first_vertices) / 2);
  return most < static_cast<double>(size_.patch) ? std::max<std::size_t>(1, static_cast<std::size_t>(most))
                                                 : size_.patch;
}

void DividedChunks::take_whole(WorkItem& item) {
  // The memory of a stretch must not go into the chunks in flight.
  if (reservation_.bytes() != 0) {
    stretch_.shrink_to_fit();
    reservation_.resize(0);
  }
  std::swap(item.chunk, stretch_.chunk);
  std::swap(item.values, stretch_.values);
  std::swap(item.end, stretch_.end);
  item.can_resume_after = stretch_.can_resume_after;
}

void DividedChunks::divide() {
  reservation_.resize(std::max<std::uint64_t>(reservation_.bytes(), stretch_.memory_bytes()));
  patches_.divide(stretch_.chunk, patch_size());
  next_patch_ = 0;
  local_.resize(stretch_.chunk.vertex_count());
  reservation_.resize(stretch_.memory_bytes() + patches_.memory_bytes() + 4 * (local_.capacity() + taken_.capacity()));
}

void DividedChunks::take_patch(WorkItem& item) {
  number_corners(patches_.patch(next_patch_), item.chunk.corners);
  if (next_patch_ == 0) add_loose_vertices();
  take_vertices(item);
  item.end = stretch_.end;
  ++next_patch_;
  item.can_resume_after = next_patch_ == patches_.patch_count();
}

// Numbers the vertices of a patch in order of first appearance, in taken_.
void DividedChunks::number_corners(std::span<const std::uint32_t> triangles, std::vector<std::uint32_t>& corners) {
  taken_.clear();
  corners.resize(3 * triangles.size());
  auto corner = corners.begin();
  for (const std::uint32_t triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = stretch_.chunk.corners[3 * std::size_t{triangle} + k];
      std::uint32_t number = local_[vertex];
      if (number >= taken_.size() || taken_[number] != vertex) {
        number = local_[vertex] = static_cast<std::uint32_t>(taken_.size());
        taken_.push_back(vertex);
      }
      *corner++ = number;
    }
}

// Vertices of the stretch that no triangle uses.
void DividedChunks::add_loose_vertices() {
  const std::span<const std::uint16_t> last = patches_.last_patches();
  for (std::uint32_t vertex = 0; vertex < last.size(); ++vertex)
    if (last[vertex] == PatchPartition::kNoPatch) taken_.push_back(vertex);
}

// One array after the other, so that the processor can fetch far ahead.
void DividedChunks::take_vertices(WorkItem& item) {
  const auto gather = [this](const auto& from, auto& to) {
    to.resize(taken_.size());
    for (std::size_t i = 0; i < taken_.size(); ++i) to[i] = from[taken_[i]];
  };
  gather(stretch_.chunk.ids, item.chunk.ids);
  if (stretch_.chunk.positions.empty())
    item.chunk.positions.clear();
  else
    gather(stretch_.chunk.positions, item.chunk.positions);
  item.values.resize(stretch_.values.size());
  for (std::size_t f = 0; f < item.values.size(); ++f) gather(stretch_.values[f], item.values[f]);

  gather(stretch_.chunk.uses, item.chunk.uses);
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    const std::uint16_t last = patches_.last_patches()[taken_[i]];
    if (last == next_patch_ || last == PatchPartition::kNoPatch) continue;
    item.chunk.uses[i] |= kUsedLater;
    stretch_.chunk.uses[taken_[i]] |= kUsedEarlier;  // for the patches that follow
  }
}

}  // namespace reeb::ooc
