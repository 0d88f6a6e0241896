#include "ooc/guesses/guessed_chunks.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/sweep/chunk.h"
#include "ooc/chunks/coherence.h"
#include "ooc/threads/parallel.h"

namespace reeb::ooc {

GuessedChunks::GuessedChunks(FirstReading& reading, FunctionValues& functions, const io::TempDir& temp,
                             MemoryBudget& budget, const GuessOptions& options, const ChunkPlace& start)
    : reading_(reading),
      functions_(functions),
      lookup_(functions),
      options_(options),
      size_(options.chunk),
      guesses_(temp, budget, options.allowance_bytes) {
  pass_over(start);
}

bool GuessedChunks::next(WorkItem& item) {
  if (!read_chunk(item.chunk, [&] { lookup_.look_up(reading_.mesh(), item); })) return false;
  item.end = {.triangles = triangles_read_,
              .next_vertex = next_vertex_,
              .digest = reading_.digest(),
              .ranges = functions_.ranges()};
  return true;
}

void GuessedChunks::pass_over(const ChunkPlace& start) {
  passing_over_ = true;
  Chunk chunk;
  while ((triangles_read_ < start.triangles || next_vertex_ < start.next_vertex) && read_chunk(chunk, [] {})) continue;
  passing_over_ = false;
  if (triangles_read_ != start.triangles || next_vertex_ != start.next_vertex ||
      (triangles_read_ + next_vertex_ != 0 && reading_.digest() != start.digest))
    throw input_changed();
  if (!start.ranges.empty()) functions_.set_ranges(start.ranges);
}

bool GuessedChunks::read_chunk(Chunk& chunk, const LookUp& look_up) {
  // Corners are overwritten. Room for them that was used before need not be filled with zeros again.
  std::vector<std::uint32_t> corners = std::move(chunk.corners);
  chunk.clear();
  chunk.corners = std::move(corners);
  if (given_up_) return false;
  if (read_triangles(chunk, look_up)) return true;
  if (given_up_ || !read_rest(chunk)) return false;
  look_up();
  return true;
}

// A small batch at a time, so that corners are numbered while they are in the first-level cache.
bool GuessedChunks::read_triangles(Chunk& chunk, const LookUp& look_up) {
  constexpr std::size_t kTrianglesInCache = 1024;
  // The mesh can have far fewer triangles than a chunk that a user chose.
  constexpr std::size_t kUsualCorners = 3 * ChunkSize{}.most, kMostNumbers = std::size_t{1} << 22;
  const std::size_t most = 3 * size_.size(), room = std::min(most, kUsualCorners);
  std::size_t count = 0;
  // Triangles of a surface have half a vertex each.
  clear_with_room(chunk.ids, room / 6);
  numbers_.start(chunk.ids, std::min(size_.size() / 2, kMostNumbers));
  if (chunk.corners.capacity() < room) clear_with_room(chunk.corners, room, std::max(room, 3 * options_.chunk.most));
  while (count < most && chunk.vertex_count() <= options_.chunk.most_vertices) {
    const auto corners = reading_.next(std::min(kTrianglesInCache, (most - count) / 3));
    if (corners.empty()) break;
    // Of a small mesh, not all of the room is used.
    const std::size_t needed = count + corners.size();
    if (chunk.corners.capacity() < needed) chunk.corners.reserve(std::min(most, 2 * chunk.corners.capacity()));
    if (chunk.corners.size() < needed) chunk.corners.resize(needed);
    numbers_.number(corners, std::span(chunk.corners).subspan(count, corners.size()));
    count += corners.size();
  }
  chunk.corners.resize(count);
  if (count == 0) return false;
  triangles_read_ += count / 3;
  const auto guess = [&] { given_up_ = guesses_.add(chunk, most_open()) != UseGuesses::Verdict::kHolds; };
  // Where other threads have swept all that was read, they wait for this. The mesh keeps the ids of the input, so
  // looking up does not change them. Triangles that share few vertices are likely to be given up, and looking up would
  // read all over the file.
  if (chunk.vertex_count() <= chunk.triangle_count()) {
    in_parallel(options_.threads, 2, [&](std::size_t part) { part == 0 ? guess() : look_up(); });
  } else {
    guess();
    if (!given_up_) look_up();
  }
  if (count < most)
    size_.adapt(chunk, count / 3);
  else
    size_.adapt(chunk);
  return !given_up_;
}

bool GuessedChunks::read_rest(Chunk& chunk) {
  constexpr std::size_t kRestVertices = 16384;
  next_vertex_ = guesses_.take_rest(next_vertex_, reading_.mesh().vertex_count(), kRestVertices, chunk);
  return chunk.vertex_count() != 0;
}

// An earlier run found guessing worthwhile up to there, so the limit does not apply again.
std::uint64_t GuessedChunks::most_open() const {
  if (passing_over_) return std::numeric_limits<std::uint64_t>::max();
  return std::min(options_.most_open_vertices, usual_front(reading_.mesh().vertex_count()));
}

}  // namespace reeb::ooc
