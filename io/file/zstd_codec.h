// zstd around byte spans. Checksums are the callers': a frame's meaning decides what is covered.
#pragma once

#include <zstd.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace reeb::io {

// Keeps its tables, about 1 MB, from one call to the next: for many small pieces.
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

// The same for a single piece.
void zstd_compress(std::span<const std::byte> bytes, int level, std::vector<std::byte>& out);

// How many of these bytes are their first frame; 0 if they do not begin with one.
std::size_t zstd_frame_size(std::span<const std::byte> bytes);

// How many bytes these say that they were; 0 if they are nothing that zstd_compress wrote.
std::size_t zstd_content_size(std::span<const std::byte> bytes);

// Fills `out` exactly. False if `bytes` is not one frame of exactly out.size() bytes of content;
// never reads or writes out of bounds, whatever `bytes` holds.
bool zstd_decompress(std::span<const std::byte> bytes, std::span<std::byte> out);

}  // namespace reeb::io
