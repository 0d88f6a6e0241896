// Finalization that is guessed, for a mesh that is read once and brings none (DESIGN.md 2, 4).
#pragma once

#include <cstdint>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/engine/chunk.h"
#include "ooc/tables/paged_table.h"

namespace reeb::ooc {

// Takes a vertex for complete as soon as its triangles close around it: each vertex of its link is
// then the end of an even number of the link's edges. That is told by one sum (xor) of hashed ids.
// On a manifold mesh each triangle of which comes once no guess is wrong, but for one chance in 2^29;
// a vertex on a boundary, or with a loose edge, is never guessed.
//
// A wrong guess is seen as soon as a simplex uses the vertex again.
//
// TIME: O(1) a triangle, and one look-up in the table for a vertex of a chunk.
// MEMORY: the allowance, for a table of 4 bytes a vertex that is paged to disk.
class UseGuesses {
 public:
  UseGuesses(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes)
      : table_("guessed uses", temp, budget, allowance_bytes, 0) {}

  enum class Verdict {
    kGood,
    kRevoked,     // a vertex was used again that had been taken for complete
    kIncoherent,  // more vertices are open, or they lie further apart, than is worth guessing for
  };
  // Sets the uses of the next chunk of the stream. After another verdict than kGood they mean nothing,
  // and this is of no further use.
  Verdict add(Chunk& chunk, std::uint64_t most_open);

  // Vertices below `end`, from `first` on, that are open or were never used: appends them to a chunk
  // as vertices without simplices, to be completed with it, until it has `most`. Returns the vertex
  // to go on from.
  std::uint64_t take_rest(std::uint64_t first, std::uint64_t end, std::size_t most, Chunk& chunk);

  std::uint64_t guessed_vertices() const { return guessed_; }
  std::uint64_t revoked_guesses() const { return revoked_; }
  std::uint64_t unused_vertices() const { return unused_; }  // among those that take_rest() passed
  std::uint64_t degenerate_triangles() const { return degenerate_; }
  std::uint64_t spilled_bytes() const { return table_.pages().spilled_bytes(); }

 private:
  // Of an entry; the rest of it is the sum over the link.
  static constexpr std::uint32_t kUsed = 1, kFan = 2, kGuessed = 4, kFlags = 7;
  static bool is_closed(std::uint32_t entry) { return (entry & ~kUsed) == kFan; }

  void sum_links(const Chunk& chunk);

  PagedTable<std::uint32_t> table_;
  std::uint64_t open_ = 0, guessed_ = 0, revoked_ = 0, unused_ = 0, degenerate_ = 0;
  std::vector<std::uint32_t> hashes_, links_;  // by vertex of the chunk
  std::vector<std::uint32_t> entries_;
};

}  // namespace reeb::ooc
