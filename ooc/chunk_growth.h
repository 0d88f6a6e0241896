// How large the next chunk of a mesh is to be.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "libreeb/engine/chunk.h"
#include "ooc/chunk_source.h"

namespace reeb::ooc {

// A chunk grows while too many of its vertices are shared with others, since gluing is what such a
// chunk costs, and as far as memory allows. What comes out depends on the chunks only.
class ChunkGrowth {
 public:
  // Sizes are in units of so many triangles.
  explicit ChunkGrowth(const ChunkSize& limits, std::size_t unit = 1)
      : limits_(limits),
        least_(std::max<std::size_t>(1, limits.first / unit)),
        most_(std::max<std::size_t>(1, limits.most / unit)),
        size_(least_) {}

  std::size_t size() const { return size_; }
  void set_size(std::size_t size) { size_ = size; }

  // Whether memory does not suffice for another sweep beside that of the chunk.
  bool must_be_swept_alone(const Chunk& chunk) const {
    return limits_.parallel.bytes(triangles(chunk), shared(chunk)) > allowance();
  }

  // To be called with each chunk, once its uses are known.
  void adapt(const Chunk& chunk) {
    // Grow above this share of shared vertices, shrink below a quarter of it. A shared vertex brings
    // about one shared edge, of three in all, so this is a tenth of the edges.
    constexpr double kManyShared = 0.30;
    if (least_ == most_) return;
    const double shared_here = shared(chunk), all = static_cast<double>(chunk.vertex_count());
    const auto before = static_cast<double>(size_);
    if (shared_here > kManyShared * all && size_ < most_)
      size_ = std::min(2 * size_, most_);
    else if (shared_here < kManyShared / 4 * all && size_ > least_)
      size_ = std::max(size_ / 2, least_);
    // The border of a chunk grows as the root of its area.
    const auto fits = [&](std::size_t size) {
      const double area = static_cast<double>(size) / before;
      return limits_.alone.bytes(triangles(chunk) * area, shared_here * std::sqrt(area)) <= allowance();
    };
    while (size_ > 1 && !fits(size_)) size_ -= std::max<std::size_t>(1, size_ / 16);
  }

 private:
  static double triangles(const Chunk& chunk) { return static_cast<double>(chunk.triangle_count()); }
  static double shared(const Chunk& chunk) {
    return static_cast<double>(
        std::count_if(chunk.uses.begin(), chunk.uses.end(), [](std::uint8_t u) { return u != kUsedHereOnly; }));
  }
  double allowance() const { return static_cast<double>(limits_.allowance_bytes); }

  ChunkSize limits_;
  std::size_t least_, most_, size_;
};

}  // namespace reeb::ooc
