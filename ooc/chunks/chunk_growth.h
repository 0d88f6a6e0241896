// The size of the next chunk of a mesh.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "libreeb/engine/chunk.h"
#include "ooc/chunks/chunk_source.h"

namespace reeb::ooc {

// Chunks grow while too many of their vertices are shared with other chunks, since gluing a chunk costs its shared
// vertices. The sizes depend on the chunks only.
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
    // A larger share of shared vertices makes the next chunk larger, less than a quarter of it makes it smaller. A
    // shared vertex brings about one shared edge, of three in all, so this is a tenth of the edges.
    constexpr double kShareToGrow = 0.30;
    const auto shared = static_cast<double>(
        std::count_if(chunk.uses.begin(), chunk.uses.end(), [](std::uint8_t u) { return u != kUsedHereOnly; }));
    const double many = kShareToGrow * static_cast<double>(chunk.vertex_count());
    if (shared > many)
      size_ = std::min(2 * size_, most_);
    else if (shared < many / 4)
      size_ = std::max(size_ / 2, least_);
    if (size) size_ = std::min(size_, *size);
  }

 private:
  std::size_t least_, most_, size_;
};

}  // namespace reeb::ooc
