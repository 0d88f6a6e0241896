// Guessed finalization, for a mesh that is read once and does not finalize its vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/sweep/chunk.h"
#include "ooc/tables/paged_table.h"

namespace reeb::ooc {

// Takes a vertex for complete as soon as its triangles close around it: each vertex of its link is then the end of an
// even number of the link's edges. One sum (xor) of hashed ids detects that. On a manifold mesh that lists each
// triangle once, no guess is wrong, except with a chance of one in 2^29. A vertex on a boundary, or with a loose edge,
// is never guessed.
//
// A wrong guess is detected as soon as a simplex uses the vertex again.
//
// TIME: O(1) per triangle, and one look-up in the table per vertex of a chunk.
// MEMORY: the allowance, for a table of 4 bytes per vertex that is paged to disk, apart from pages whose vertices are
// all taken for complete.
class UseGuesses {
 public:
  UseGuesses(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes)
      : table_("guessed uses", temp, budget, allowance_bytes, 0, kGuessed) {}

  enum class Verdict {
    kHolds,
    kRevoked,     // a vertex that had been taken for complete was used again
    kIncoherent,  // too many vertices are open, or they are too far apart, for guessing to pay
  };
  // Sets the uses of the next chunk of the stream. After any verdict but kHolds the uses mean nothing, and this object
  // must not be used again.
  Verdict add(Chunk& chunk, std::uint64_t most_open);

  // Appends vertices below `end`, starting at `first`, that are open or were never used to a chunk, until it has
  // `most`. They become vertices without simplices that the chunk completes. Returns the vertex to continue from.
  std::uint64_t take_rest(std::uint64_t first, std::uint64_t end, std::size_t most, Chunk& chunk);

  std::uint64_t guessed_vertices() const { return guessed_; }
  std::uint64_t revoked_guesses() const { return revoked_; }
  std::uint64_t unused_vertices() const { return unused_; }  // among those that take_rest() has visited
  std::uint64_t degenerate_triangles() const { return degenerate_; }
  std::uint64_t spilled_bytes() const { return table_.pages().spilled_bytes(); }

 private:
  // Flags of an entry; its other bits are the sum over the link.
  static constexpr std::uint32_t kUsed = 1, kFan = 2, kGuessed = 4, kFlags = 7;
  static bool is_closed(std::uint32_t entry) { return (entry & ~kUsed) == kFan; }

  void sum_links(const Chunk& chunk);
  bool sum_of_triangles(const Chunk& chunk);
  void sum_of_all(const Chunk& chunk);

  PagedTable<std::uint32_t> table_;
  std::uint64_t open_ = 0, guessed_ = 0, revoked_ = 0, unused_ = 0, degenerate_ = 0;
  std::vector<std::uint32_t> hashes_, links_;  // by vertex of the chunk
  std::vector<std::uint32_t> entries_;
};

}  // namespace reeb::ooc
