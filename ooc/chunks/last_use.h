// Finalization: the block of triangles that uses each vertex last.
//
// The table depends on the mesh only, not on the function. On request it is kept in a file next to the mesh
// (ooc/chunks/last_use_sidecar.h). It also shows, before the run, how many vertices will be live.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "io/file/checksum.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/indexed_mesh.h"
#include "ooc/tables/paged_table.h"

namespace reeb::ooc {

// The blocks of consecutive triangles that use a vertex: the last block in the high 20 bits; by how many blocks the
// first one comes before it, in the low 12.
class UseEntry {
 public:
  static constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  static constexpr std::uint32_t kSaturatedSpan = 0xfff;  // this many or more: the first block is not known
  static constexpr std::uint32_t kMostBlocks = (1u << 20) - 2;

  explicit UseEntry(std::uint32_t packed = kUnused) : packed_(packed) {}
  UseEntry(std::uint32_t last_block, std::uint32_t span)
      : packed_(last_block << 12 | (span < kSaturatedSpan ? span : kSaturatedSpan)) {}

  bool unused() const { return packed_ == kUnused; }
  // The next two REQUIRE a used vertex.
  std::uint32_t last_block() const { return packed_ >> 12; }
  std::uint32_t span() const { return packed_ & kSaturatedSpan; }
  std::uint32_t packed() const { return packed_; }

  // The entry once this block uses the vertex, too. REQUIRES: no later one did.
  UseEntry used_by(std::uint32_t block) const {
    if (unused()) return {block, 0};
    if (span() == kSaturatedSpan) return {block, kSaturatedSpan};
    return {block, block - (last_block() - span())};
  }

 private:
  std::uint32_t packed_;
};

struct LastUseOptions {
  std::uint64_t block_triangles = 4096;      // doubled whenever there would be more than most_blocks
  std::uint64_t allowance_bytes = 16 << 20;  // of the budget, for the table
  // Give up early on a mesh so incoherent that pages of the table would be read and written all the time.
  bool give_up_when_incoherent = false;
  // Give up as soon as it is certain, or nearly (last_use.cpp), that more vertices than this are live at once.
  std::uint64_t most_live_vertices = ~std::uint64_t{0};
  std::uint32_t most_blocks = UseEntry::kMostBlocks;
  unsigned threads = 1;  // with two or more, one reads the mesh while another fills the table
  // Called about once per block, with the number of bytes of the mesh read so far.
  std::function<void(std::uint64_t)> progress = {};
};

// What the pass learned in addition to the table.
struct UseSummary {
  std::uint64_t vertex_count = 0;
  std::uint64_t unused_vertices = 0;
  std::uint64_t triangle_count = 0;  // degenerate ones included
  std::uint64_t degenerate_triangles = 0;
  std::uint64_t block_triangles = 0;
  std::uint64_t block_count = 0;
  // A vertex is live at the end of a block if it was used up to there and will be used again.
  std::uint64_t max_live_vertices = 0;
  std::uint64_t digest = 0;  // of all triangles, as IndexedMesh::read delivers them
  // Live vertices along the stream: the maxima of at most 256 groups of the same number of blocks each.
  std::vector<std::uint64_t> live_profile;

  friend bool operator==(const UseSummary&, const UseSummary&) = default;
};

// Whether its blocks are as small as they can be, unless the options ask for large ones. A chunk is whole blocks.
inline bool has_usual_blocks(const UseSummary& summary) {
  constexpr std::uint64_t kUsual = 4096;
  return summary.block_triangles != 0 &&
         (summary.block_triangles <= kUsual || summary.block_count > UseEntry::kMostBlocks / 2);
}

class LastUse {
 public:
  LastUse(UseSummary summary, PagedTable<std::uint32_t> table)
      : summary_(std::move(summary)), table_(std::move(table)) {}

  const UseSummary& summary() const { return summary_; }
  // Counts only the vertices that triangles use: for a mesh that is a share of a larger one.
  void leave_out_unused() { summary_.vertex_count -= std::exchange(summary_.unused_vertices, 0); }
  std::uint64_t spilled_bytes() const { return table_.pages().spilled_bytes(); }

  // entries[i] = UseEntry::packed of ids[i]. Fast if ids are near each other.
  // REQUIRES: ids are below vertex_count; ids and entries have the same length.
  void lookup(std::span<const VertexId> ids, std::span<std::uint32_t> entries) {
    for (std::size_t i = 0; i < ids.size(); ++i) entries[i] = table_.get(ids[i].value());
  }

  // The first vertex from `first` on that may be used; vertex_count if there is none.
  std::uint64_t next_used(std::uint64_t first) const { return table_.next_set(first, summary_.vertex_count); }
  // The packed entries of consecutive vertices, starting at `first`.
  void read(VertexId first, std::span<std::uint32_t> entries) { table_.read(first.value(), entries); }

 private:
  UseSummary summary_;
  PagedTable<std::uint32_t> table_;
};

// The first pass over triangles as they come: look_at() and then use() for each of them, and finish().
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: the allowance and 4 bytes per block.   TIME: O(triangles + vertices).
// THREADS: one may call look_at() and gave_up() while another calls use(); else one at a time.
class LastUseScan {
 public:
  // `triangles_by_size`: as of IndexedMesh, or 0 if it is not known.
  LastUseScan(std::uint64_t vertex_count, std::uint64_t triangles_by_size, const io::TempDir& temp,
              MemoryBudget& budget, const LastUseOptions& options);

  // Takes what does not depend on earlier triangles.
  void look_at(std::span<const VertexId> corners);
  // `bytes_read`, of the mesh up to here, is for the progress.
  void use(std::span<const VertexId> corners, std::uint64_t bytes_read = 0);
  bool gave_up() const { return gave_up_; }
  LastUse finish();

 private:
  void open_block();
  void close_block(std::uint64_t bytes_read);
  void use_in_block(std::span<const VertexId> corners);
  bool is_scattered() const;
  void double_blocks();
  void profile_front();

  LastUseOptions options_;
  PagedTable<std::uint32_t> table_;
  std::size_t most_blocks_;  // even, so that blocks can be joined in pairs
  std::uint64_t block_triangles_;
  std::uint64_t in_block_ = 0;  // triangles of the last block so far
  std::atomic<bool> gave_up_ = false;
  Reservation change_charge_;
  // Of look_at().
  io::RunningDigest digest_;
  std::uint64_t degenerate_ = 0;
  // By block: vertices used first in it, minus those used last.
  std::vector<std::int32_t> live_change_;
  // Over the blocks so far, the sum of the vertices known to be live at their ends.
  std::uint64_t carried_ = 0;
  std::uint64_t introduced_ = 0;  // vertices used so far
  std::uint64_t triangles_by_size_;
  UseSummary summary_;
};

// The first pass: reads all triangles of `mesh` once, starting at the first. Returns nothing if the options allow
// giving up, and it gave up.
//
// THROWS: what reading the mesh throws; Error{kResource} of the budget or the disk.
// MEMORY: the allowance and 4 bytes per block.   TIME: O(triangles + vertices).
std::optional<LastUse> scan_last_use(IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget,
                                     const LastUseOptions& options = {});

}  // namespace reeb::ooc
