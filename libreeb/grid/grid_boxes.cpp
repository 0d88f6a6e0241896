#include "libreeb/grid/grid_boxes.h"

namespace reeb {

// Of the boxes that have a vertex, those at lower ends come earlier, and those at higher ends later.
void GridBoxes::fill(const std::array<std::uint64_t, 3>& box, Chunk& chunk) const {
  chunk.clear();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    chunk.box[axis] = size(axis, box[axis]);
    if (box[axis] != 0) chunk.shared_faces |= static_cast<std::uint8_t>(1u << (2 * axis));
    if (box[axis] + 1 != count(axis)) chunk.shared_faces |= static_cast<std::uint8_t>(2u << (2 * axis));
  }
  const auto& [ni, nj, nk] = chunk.box;
  const auto use = [&](std::size_t axis, std::uint32_t i) {
    const unsigned shared = unsigned{chunk.shared_faces} >> (2 * axis) & 3u;
    return static_cast<std::uint8_t>((i == 0 && (shared & 1) != 0 ? kUsedEarlier : 0) |
                                     (i + 1 == chunk.box[axis] && (shared & 2) != 0 ? kUsedLater : 0));
  };
  chunk.ids.reserve(std::size_t{ni} * nj * nk);
  chunk.uses.reserve(std::size_t{ni} * nj * nk);
  for (std::uint32_t k = 0; k < nk; ++k)
    for (std::uint32_t j = 0; j < nj; ++j) {
      const std::uint64_t row =
          first(0, box[0]) + grid_[0] * (first(1, box[1]) + j + grid_[1] * (first(2, box[2]) + k));
      const std::uint8_t use_of_row = use(1, j) | use(2, k);
      for (std::uint32_t i = 0; i < ni; ++i) {
        chunk.ids.emplace_back(row + i);
        chunk.uses.push_back(use_of_row | use(0, i));
      }
    }
}

}  // namespace reeb
