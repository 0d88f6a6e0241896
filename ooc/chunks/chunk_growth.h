// The size of the next chunk of a mesh.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "libreeb/sweep/chunk.h"
#include "ooc/chunks/chunk_source.h"

namespace reeb::ooc {

// Chunks grow while too many of their vertices are shared with other chunks, since gluing a chunk costs its shared
// vertices. They double, and large ones grow in smaller steps, since these take memory. The sizes depend on the chunks
// only.
class ChunkGrowth {
 public:
  // `limits` count triangles; size() counts units of `unit` triangles each.
  explicit ChunkGrowth(const ChunkSize& limits, std::size_t unit = 1)
      : least_(std::max<std::size_t>(1, limits.first / unit)),
        most_(std::max<std::size_t>(1, limits.most / unit)),
        size_(least_) {}

  std::size_t size() const { return size_; }
  void set_size(std::size_t size) { size_ = std::min(size, most_); }

  // Call this with each chunk once its uses are known. `size` is its size if it ended early, because of its vertices.
  void adapt(const Chunk& chunk, std::optional<std::size_t> size = {}) {
    // Of the vertices. A strip of twice the height has half the share, so its size settles between the two.
    constexpr double kShareToGrow = 0.12, kShareToShrink = 0.05;
    const auto shared = static_cast<double>(
        std::count_if(chunk.uses.begin(), chunk.uses.end(), [](std::uint8_t u) { return u != kUsedHereOnly; }));
    const auto all = static_cast<double>(chunk.vertex_count());
    if (shared > kShareToGrow * all)
      size_ = std::min(size_ + std::min(size_, std::max<std::size_t>(1, most_ / 4)), most_);
    else if (shared < kShareToShrink * all)
      size_ = std::max(size_ / 2, least_);
    if (size) size_ = std::min(size_, *size);
  }

 private:
  std::size_t least_, most_, size_;
};

}  // namespace reeb::ooc
