// Divides the triangles of a chunk into patches of triangles that are near each other in space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/sweep/chunk.h"

namespace reeb::ooc {

// A k-d tree on a sample of the triangles: their box is cut across its longest side at the median, then each half is
// cut in the same way. Triangles that are all, or nearly all, at one point, or have no positions, are cut in the middle
// of the stream. The position of a triangle is that of its first corner.
//
// TIME: O(n log(n / most)), about 5 ns per triangle, half of which `threads` threads share.
// MEMORY: 4 bytes per triangle and 4 per vertex, or 6 per triangle and 2 per vertex if the stream is cut.
class PatchPartition {
 public:
  explicit PatchPartition(unsigned threads) : threads_(threads) {}

  // Cuts patches of at most about `most` triangles, none of them empty; of more where there would be more than some
  // 16,000 patches. The limit is exact if it is less than 256. REQUIRES: most >= 1; the chunk has triangles.
  void divide(const Chunk& chunk, std::size_t most);

  // 0 before the first division.
  std::size_t patch_count() const { return begin_.size() - 1; }
  // The triangles of a patch, in stream order. Successive patches are mostly neighbours.
  std::span<const std::uint32_t> patch(std::size_t index) const {
    return std::span(triangles_).subspan(begin_[index], begin_[index + 1] - begin_[index]);
  }
  // Of each vertex the last patch with a triangle that uses it; kNoPatch if there is none.
  static constexpr std::uint16_t kNoPatch = 0xffff;
  std::span<const std::uint16_t> last_patches() const { return last_patch_; }
  std::size_t memory_bytes() const;

 private:
  static constexpr std::size_t kStream = 3;  // a fourth axis: the index in the stream
  struct Cut {
    std::size_t axis = 0;
    double at = 0;
    std::uint32_t below = 0, above = 0;  // cuts, or patches with kIsPatch
  };
  static constexpr std::uint32_t kIsPatch = 1u << 31;

  static double place(const Chunk& chunk, std::uint32_t triangle, std::size_t axis) {
    return axis == kStream ? triangle : chunk.positions[chunk.corners[3 * std::size_t{triangle}]][axis];
  }
  std::uint32_t cut(const Chunk& chunk, std::span<std::uint32_t> sample, std::size_t most);
  std::size_t divide_sample(const Chunk& chunk, std::span<std::uint32_t> sample, Cut& cut) const;
  template <class PlaceOn>
  std::uint16_t patch_at(const PlaceOn& place_on, std::uint32_t root) const;
  void find_patches(const Chunk& chunk, std::uint32_t root);
  void collect(const Chunk& chunk);

  unsigned threads_;
  std::vector<Cut> cuts_;
  std::uint32_t patches_ = 0;
  bool cuts_stream_ = false;
  std::vector<std::uint16_t> patch_of_;    // by first corner; by triangle if the stream is cut
  std::vector<std::uint16_t> last_patch_;  // by vertex
  std::vector<std::uint32_t> begin_{0};
  std::vector<std::uint32_t> triangles_;  // first the sample
};

}  // namespace reeb::ooc
