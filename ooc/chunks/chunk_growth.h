// The size of the next chunk of a mesh.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "libreeb/sweep/chunk.h"
#include "ooc/chunks/chunk_source.h"

namespace reeb::ooc {

// Chunks grow while too many of their vertices are shared with other chunks, since gluing a chunk costs its shared
// vertices. They double, and large ones grow in smaller steps, since these take memory. The sizes depend on the chunks
// only.
//
// Cutting a larger chunk into patches (divided_chunks.h) costs more than it saves if the chunks of the first size are
// about as compact as patches would be. So these grow only if much more is shared than patches share.
class ChunkGrowth {
 public:
  // `limits` count triangles; size() counts units of `unit` triangles each.
  explicit ChunkGrowth(const ChunkSize& limits, std::size_t unit = 1)
      : least_(std::max<std::size_t>(1, limits.first / unit)),
        most_(std::max<std::size_t>(1, limits.most / unit)),
        size_(least_),
        most_shared_at_least_(most_shared(limits.first)) {}

  std::size_t size() const { return size_; }
  void set_size(std::size_t size) { size_ = std::min(size, most_); }

  // Call this with each chunk once its uses are known. `size` is its size if it ended early, because of its vertices.
  void adapt(const Chunk& chunk, std::optional<std::size_t> size = {}) {
    const auto count = static_cast<double>(
        std::count_if(chunk.uses.begin(), chunk.uses.end(), [](std::uint8_t u) { return u != kUsedHereOnly; }));
    const double shared = count / std::max(1.0, static_cast<double>(chunk.vertex_count()));
    // A strip of half the height has twice the share, and must not grow again.
    const double too_few = size_ / 2 <= least_ ? 0.45 * most_shared_at_least_ : kShareToShrink;
    if (shared > (size_ == least_ ? most_shared_at_least_ : kShareToGrow))
      size_ = std::min(size_ + std::min(size_, std::max<std::size_t>(1, most_ / 4)), most_);
    else if (shared < too_few)
      size_ = std::max(size_ / 2, least_);
    if (size) size_ = std::min(size_, *size);
  }

 private:
  // Shares of the vertices. A strip of twice the height has half the share, so its size settles between the two.
  static constexpr double kShareToGrow = 0.12, kShareToShrink = 0.05;

  // Patches of a scan share about twice as many vertices as a square of their size; this is four times as many. Where a
  // quarter is shared, dividing pays.
  static double most_shared(std::size_t triangles) {
    const double of_square = 4 / std::sqrt(static_cast<double>(std::max<std::size_t>(1, triangles)) / 2);
    return std::clamp(4 * of_square, kShareToGrow, 0.25);
  }

  std::size_t least_, most_, size_;
  double most_shared_at_least_;
};

}  // namespace reeb::ooc
