#include "libreeb/grid/grid_boxes.h"

namespace reeb {

BoxFaces GridBoxes::shared_faces(const std::array<std::uint64_t, 3>& box) const {
  unsigned faces = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box[axis] != 0) faces |= low_face(axis);
    if (box[axis] + 1 != count(axis)) faces |= high_face(axis);
  }
  return static_cast<BoxFaces>(faces);
}

void GridBoxes::fill(const std::array<std::uint64_t, 3>& box, Chunk& chunk) const {
  chunk.clear();
  for (std::size_t axis = 0; axis < 3; ++axis) chunk.box[axis] = size(axis, box[axis]);
  chunk.shared_faces = shared_faces(box);
  const auto& [ni, nj, nk] = chunk.box;
  const auto faces = [&](std::size_t axis, std::uint32_t i) {
    const unsigned ends = (i == 0 ? low_face(axis) : 0u) | (i + 1 == chunk.box[axis] ? high_face(axis) : 0u);
    return static_cast<BoxFaces>(chunk.shared_faces & ends);
  };
  chunk.ids.reserve(std::size_t{ni} * nj * nk);
  chunk.uses.reserve(std::size_t{ni} * nj * nk);
  for (std::uint32_t k = 0; k < nk; ++k)
    for (std::uint32_t j = 0; j < nj; ++j) {
      const std::uint64_t row =
          first(0, box[0]) + grid_[0] * (first(1, box[1]) + j + grid_[1] * (first(2, box[2]) + k));
      const BoxFaces faces_of_row = faces(1, j) | faces(2, k);
      for (std::uint32_t i = 0; i < ni; ++i) {
        chunk.ids.emplace_back(row + i);
        chunk.uses.push_back(faces_of_row | faces(0, i));
      }
    }
}

}  // namespace reeb
