// Triangles in a few bytes each, written once and read in order any number of times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/indexed_mesh.h"

namespace reeb::ooc {

// Corners are stored as differences to corners near by, each in 1, 2, 4 or 8 bytes, after one byte with their lengths:
// 4 to 7 bytes per triangle of a coherent mesh. Each block of 64 KiB can be decoded alone. The first blocks stay in
// memory as far as allowance and budget permit; the others go to an unnamed file.
//
// THROWS: Error{kResource} of the budget or the disk.   THREADS: one at a time.
class TriangleLog {
 public:
  TriangleLog(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes);

  // REQUIRES: three corners per triangle; nothing was read yet.
  void append(std::span<const VertexId> corners);

  void rewind();
  // Replaces `corners` by those of the next triangles, at most `limit`. False at the end.
  bool read(std::vector<VertexId>& corners, std::size_t limit);
  // Where read() goes on; and to go on there.
  MeshPlace place() const { return {read_block_ * kBlockBytes + read_at_, read_before_}; }
  void seek(const MeshPlace& place);

  std::uint64_t triangle_count() const { return triangle_count_; }
  // Encoded bytes: in all; before the reading position; and in the file.
  std::uint64_t bytes_total() const { return block_count_ * kBlockBytes + write_at_; }
  std::uint64_t bytes_read() const { return read_block_ * kBlockBytes + read_at_; }
  std::uint64_t spilled_bytes() const { return (block_count_ - in_memory_.size()) * kBlockBytes; }

 private:
  static constexpr std::size_t kBlockBytes = 64 << 10;
  using Block = std::unique_ptr<std::byte[]>;

  void seal_block();
  const std::byte* block(std::uint64_t index);

  const io::TempDir* temp_;
  std::uint64_t allowance_;
  Reservation charge_;
  std::vector<Block> in_memory_;  // blocks 0, 1, ...
  io::File file_;                 // the blocks after them
  std::uint64_t block_count_ = 0;
  std::uint64_t triangle_count_ = 0;

  Block open_;  // the block being written
  std::size_t write_at_ = 0;
  std::uint64_t write_before_ = 0;  // the corner that the next one is encoded relative to

  Block fetched_;  // a block of the file
  std::uint64_t fetched_index_ = ~std::uint64_t{0};
  std::uint64_t read_block_ = 0, read_before_ = 0;
  std::size_t read_at_ = 0;
};

}  // namespace reeb::ooc
