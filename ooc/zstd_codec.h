// zstd around byte spans. Checksums are the callers': a frame's meaning decides what is covered.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace reeb::ooc {

// Appends the compressed form of `bytes` to `out`. Level 1 is the fast default of temporary files.
void zstd_compress(std::span<const std::byte> bytes, int level, std::vector<std::byte>& out);

// How many bytes these say that they were; 0 if they are nothing that zstd_compress wrote.
std::size_t zstd_content_size(std::span<const std::byte> bytes);

// Fills `out` exactly. False if `bytes` is not one frame of exactly out.size() bytes of content;
// never reads or writes out of bounds, whatever `bytes` holds.
bool zstd_decompress(std::span<const std::byte> bytes, std::span<std::byte> out);

}  // namespace reeb::ooc
