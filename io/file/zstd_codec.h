// zstd for spans of bytes. Checksums are left to the callers, which know what has to be covered.
#pragma once

#include <zstd.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace reeb::io {

// Keeps its tables, about 1 MB, from one call to the next: for many small blocks.
// THREADS: one at a time.
class ZstdCompressor {
 public:
  ZstdCompressor();
  // Appends the compressed form of `bytes` to `out`. Level 1 is the fast default of temporary files.
  void compress(std::span<const std::byte> bytes, int level, std::vector<std::byte>& out);

 private:
  struct Free {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  };
  std::unique_ptr<ZSTD_CCtx, Free> context_;
  std::unique_ptr<std::byte[]> frame_;
  std::size_t capacity_ = 0;
};

// The same for a single block.
void zstd_compress(std::span<const std::byte> bytes, int level, std::vector<std::byte>& out);

// The size of the frame at the beginning of `bytes`; 0 if there is none.
std::size_t zstd_frame_size(std::span<const std::byte> bytes);

// The content size that the frame announces; 0 if `bytes` is not from zstd_compress().
std::size_t zstd_content_size(std::span<const std::byte> bytes);

// Fills `out` exactly. False if `bytes` is not one frame with exactly out.size() bytes of content. Never reads or
// writes out of bounds, whatever `bytes` contains.
bool zstd_decompress(std::span<const std::byte> bytes, std::span<std::byte> out);

}  // namespace reeb::io
