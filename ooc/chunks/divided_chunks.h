// Cuts the large chunks of a source into patches (docs/ARCHITECTURE.md, Wide fronts).
//
// Where the front is wide, a chunk of consecutive triangles is a thin strip: nearly all of it is border, and gluing
// costs the length of the border. So a stretch of many chunks is read at once and cut across into patches, whose
// borders are short. Each patch is swept on its own in scratch memory, so a stretch costs a small part of what a chunk
// of its size costs. Any partition gives the same result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/patch_partition.h"

namespace reeb::ooc {

// MEMORY: reserved: the stretch and about 8 bytes per triangle of it; nothing if chunks are small enough.
class DividedChunks : public ChunkSource {
 public:
  // `stretches` must outlive this. Chunks of at most about size.first triangles and size.first_vertices vertices pass
  // unchanged. Others are cut into patches of at most about size.patch triangles, fewer if they have many vertices.
  // `threads` threads divide.
  // THROWS, in next(): Error{kResource} of the budget.
  DividedChunks(ChunkSource& stretches, const ChunkSize& size, MemoryBudget& budget, unsigned threads)
      : stretches_(stretches), size_(size), reservation_(budget.reserve("stretch of chunks", 0)), patches_(threads) {}

  bool next(WorkItem& item) override;
  std::uint64_t bytes_read() const override { return stretches_.bytes_read(); }
  std::uint64_t bytes_total() const override { return stretches_.bytes_total(); }
  std::uint64_t triangles_read() const override { return stretches_.triangles_read(); }
  SimplexCounts simplices_listed() const override { return stretches_.simplices_listed(); }
  std::uint64_t vertex_count() const override { return stretches_.vertex_count(); }
  std::uint64_t vertex_bound() const override { return stretches_.vertex_bound(); }

 private:
  bool is_small(const Chunk& chunk) const;
  std::size_t patch_size() const;
  void take_whole(WorkItem& item);
  void divide();
  void take_patch(WorkItem& item);
  void number_corners(std::span<const std::uint32_t> triangles, std::vector<std::uint32_t>& corners);
  void add_loose_vertices();
  void take_vertices(WorkItem& item);

  ChunkSource& stretches_;
  ChunkSize size_;
  Reservation reservation_;
  WorkItem stretch_;
  PatchPartition patches_;
  std::size_t next_patch_ = 0;
  // By vertex of the stretch.
  std::vector<std::uint32_t> local_;  // its number in the current patch, if taken_ has it at that number
  std::vector<std::uint32_t> taken_;  // vertices of the current patch
};

}  // namespace reeb::ooc
