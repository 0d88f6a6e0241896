// Chunks of a mesh without finalization, made while it is read for the first time.
#pragma once

#include <cstdint>
#include <functional>

#include "ooc/chunks/chunk_growth.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/vertex_lookup.h"
#include "ooc/guesses/first_reading.h"
#include "ooc/guesses/use_guesses.h"
#include "ooc/tables/local_numbers.h"

namespace reeb::ooc {

struct GuessOptions {
  ChunkSize chunk;
  std::uint64_t allowance_bytes = 16 << 20;  // of the budget, for the table of guesses
  // With more open vertices than this, or than a coherent mesh of its size has, guessing is not worthwhile.
  std::uint64_t most_open_vertices = ~std::uint64_t{0};
  unsigned threads = 1;  // with more, vertices of a chunk are looked up while their uses are guessed
};

// Cuts chunks from a mesh and guesses which vertices are complete (use_guesses.h).
//
// A wrong guess or an incoherent mesh ends the chunks early. Then given_up() is true, and the caller discards the
// results of the chunks and runs the mesh again, with known last uses. So the result is exact in either case, and a
// guess affects the time only. Where chunks are cut, and so whether a guess fails, does not depend on threads.
class GuessedChunks : public ChunkSource {
 public:
  // All must outlive this. The chunks before `start` are skipped: read, but not looked up.
  // REQUIRES: nothing was read yet; `start` was made with the same options.
  // THROWS: Error{kChanged} if the mesh is not the one that `start` was made of.
  GuessedChunks(FirstReading& reading, FunctionValues& functions, const io::TempDir& temp, MemoryBudget& budget,
                const GuessOptions& options, const ChunkPlace& start = {});

  bool next(WorkItem& item) override;
  std::uint64_t bytes_read() const override { return reading_.bytes_read(); }
  std::uint64_t bytes_total() const override { return reading_.bytes_total(); }
  std::uint64_t triangles_read() const override { return triangles_read_; }
  SimplexCounts simplices_listed() const override { return reading_.mesh().simplex_counts(); }
  std::uint64_t vertex_count() const override { return reading_.mesh().vertex_count(); }

  bool given_up() const override { return given_up_; }
  const UseGuesses& guesses() const { return guesses_; }

 private:
  using LookUp = std::function<void()>;  // of the vertices of a chunk

  void pass_over(const ChunkPlace& start);
  bool read_chunk(Chunk& chunk, const LookUp& look_up);
  bool read_triangles(Chunk& chunk, const LookUp& look_up);
  bool read_rest(Chunk& chunk);
  std::uint64_t most_open() const;

  FirstReading& reading_;
  FunctionValues& functions_;
  VertexLookup lookup_;
  GuessOptions options_;
  ChunkGrowth size_;  // in triangles
  UseGuesses guesses_;
  LocalNumbers numbers_;
  std::uint64_t triangles_read_ = 0;
  std::uint64_t next_vertex_ = 0;  // the search for vertices that no guess completed continues here
  bool passing_over_ = false, given_up_ = false;
};

}  // namespace reeb::ooc
