#include <algorithm>
#include <stdexcept>

#include "io/file/checksum.h"
#include "libreeb/base/error.h"
#include "ooc/chunks/chunk_growth.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/vertex_lookup.h"
#include "ooc/tables/local_numbers.h"

namespace reeb::ooc {
namespace {

class IndexedChunks : public ChunkSource {
 public:
  IndexedChunks(IndexedMesh& mesh, LastUse& last_use, FunctionValues& functions, ChunkSize size,
                const ChunkPlace& start)
      : mesh_(mesh),
        last_use_(last_use),
        functions_(functions),
        lookup_(functions),
        block_triangles_(static_cast<std::size_t>(std::max<std::uint64_t>(1, last_use.summary().block_triangles))),
        blocks_(size, block_triangles_),
        most_vertices_(size.most_vertices) {
    mesh_.rewind();
    pass_over(start);
  }

  bool next(WorkItem& item) override;
  std::uint64_t bytes_read() const override { return mesh_.bytes_read(); }
  std::uint64_t bytes_total() const override { return mesh_.bytes_total(); }
  std::uint64_t triangles_read() const override { return triangles_read_; }
  SimplexCounts simplices_listed() const override { return mesh_.simplex_counts(); }
  std::uint64_t vertex_count() const override { return mesh_.vertex_count(); }
  std::uint64_t vertex_bound() const override { return mesh_.number_count(); }

 private:
  void pass_over(const ChunkPlace& start);
  bool read_some(std::size_t most);
  bool read_triangles(Chunk& chunk);
  bool read_loose_vertices(Chunk& chunk);
  void set_uses(Chunk& chunk, std::size_t blocks);
  void check_end();

  IndexedMesh& mesh_;
  LastUse& last_use_;
  FunctionValues& functions_;
  VertexLookup lookup_;
  std::size_t block_triangles_;
  ChunkGrowth blocks_;
  std::size_t most_vertices_;
  std::uint64_t first_block_ = 0;  // of the next chunk
  std::uint64_t triangles_read_ = 0;
  std::uint64_t next_vertex_ = 0;  // the search for unused vertices continues here
  std::uint64_t completed_ = 0;    // vertices that chunks so far used last
  io::RunningDigest digest_;       // of all triangles so far

  std::vector<VertexId> corners_;
  LocalNumbers numbers_;
  std::vector<std::uint32_t> entries_;
};

bool IndexedChunks::next(WorkItem& item) {
  item.chunk.clear();
  if (!read_triangles(item.chunk) && !read_loose_vertices(item.chunk)) {
    check_end();
    return false;
  }
  lookup_.look_up(mesh_, item);
  item.end = {.triangles = triangles_read_,
              .next_vertex = next_vertex_,
              .chunk_blocks = blocks_.size(),
              .digest = digest_.value(),
              .completed = completed_,
              .ranges = functions_.ranges()};
  return true;
}

void IndexedChunks::pass_over(const ChunkPlace& start) {
  constexpr std::uint64_t kTrianglesAtOnce = 65536;
  while (triangles_read_ < start.triangles &&
         read_some(static_cast<std::size_t>(std::min(kTrianglesAtOnce, start.triangles - triangles_read_))))
    triangles_read_ += corners_.size() / 3;
  if (start.triangles != 0 && digest_.value() != start.digest) throw input_changed();
  completed_ = start.completed;
  first_block_ = triangles_read_ / block_triangles_;
  next_vertex_ = start.next_vertex;
  if (start.chunk_blocks != 0) blocks_.set_size(static_cast<std::size_t>(start.chunk_blocks));
  if (!start.ranges.empty()) functions_.set_ranges(start.ranges);
}

bool IndexedChunks::read_some(std::size_t most) {
  if (!mesh_.read(corners_, most)) return false;
  if (corners_.size() > 3 * most) throw std::logic_error("a mesh gave more triangles than were asked for");
  digest_.add(std::as_bytes(std::span(corners_)));
  return true;
}

// A small batch at a time, so that corners are numbered while they are in the first-level cache. Beyond the usual size
// of a chunk, room is made for triangles that were read only: a table of last uses can promise more than there are.
bool IndexedChunks::read_triangles(Chunk& chunk) {
  constexpr std::size_t kTrianglesInCache = 1024, kUsual = ChunkSize{}.most;
  const std::uint64_t left = last_use_.summary().triangle_count - triangles_read_;
  const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(blocks_.size() * block_triangles_, left));
  numbers_.start(chunk.ids, std::min(most, kUsual));
  chunk.corners.resize(3 * std::min(most, kUsual));
  std::size_t count = 0, end_of_block = 0, blocks = 0;
  while (count < most && (count < end_of_block || chunk.vertex_count() <= most_vertices_)) {
    if (count == end_of_block) {
      end_of_block = std::min(most, end_of_block + block_triangles_);
      ++blocks;
    }
    if (!read_some(std::min(kTrianglesInCache, end_of_block - count))) break;
    const std::size_t needed = 3 * count + corners_.size();
    if (chunk.corners.size() < needed) chunk.corners.resize(std::min(3 * most, 2 * needed));
    numbers_.number(corners_, std::span(chunk.corners).subspan(3 * count, corners_.size()));
    count += corners_.size() / 3;
  }
  if (count == 0) return false;
  chunk.corners.resize(3 * count);
  triangles_read_ += count;
  set_uses(chunk, blocks);
  first_block_ += blocks;
  if (count < most)
    blocks_.adapt(chunk, blocks);
  else
    blocks_.adapt(chunk);
  return true;
}

void IndexedChunks::set_uses(Chunk& chunk, std::size_t blocks) {
  entries_.resize(chunk.vertex_count());
  last_use_.lookup(chunk.ids, entries_);
  const std::uint64_t last_block = first_block_ + blocks - 1;
  chunk.uses.resize(chunk.vertex_count());
  bool fits = true;
  std::uint64_t completed = 0;
  for (std::size_t i = 0; i < chunk.vertex_count(); ++i) {
    const UseEntry entry(entries_[i]);
    const std::uint64_t last = entry.last_block(), span = entry.span();
    // A saturated span can mark a vertex as used earlier although it was not. That is allowed.
    const bool earlier = last < first_block_ + span || span == UseEntry::kSaturatedSpan;
    const bool later = last > last_block;
    chunk.uses[i] = static_cast<std::uint8_t>((earlier ? kUsedEarlier : 0) | (later ? kUsedLater : 0));
    completed += later ? 0u : 1u;
    // The chunk is not before its first use and not after its last. An unused vertex has the last block of all.
    fits = fits && last >= first_block_ && (last <= last_block + span || span == UseEntry::kSaturatedSpan);
    fits = fits && !entry.unused();
  }
  if (!fits) throw input_changed();
  completed_ += completed;
}

// No chunk used a vertex after its last use. If each was used last in one chunk, all uses were right.
void IndexedChunks::check_end() {
  const UseSummary& uses = last_use_.summary();
  if (triangles_read_ != uses.triangle_count || mesh_.read(corners_, 1) || completed_ != uses.vertex_count ||
      digest_.value() != uses.digest)
    throw input_changed();
}

bool IndexedChunks::read_loose_vertices(Chunk& chunk) {
  constexpr std::size_t kLooseVertices = 16384;
  const std::uint64_t count = mesh_.vertex_count();
  if (last_use_.summary().unused_vertices == 0) return false;
  while (next_vertex_ < count && chunk.vertex_count() < kLooseVertices) {
    entries_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kLooseVertices, count - next_vertex_)));
    last_use_.read(VertexId(next_vertex_), entries_);
    for (const std::uint32_t entry : entries_) {
      if (UseEntry(entry).unused()) chunk.ids.push_back(VertexId(next_vertex_));
      ++next_vertex_;
    }
  }
  chunk.uses.assign(chunk.vertex_count(), kUsedHereOnly);
  completed_ += chunk.vertex_count();
  return chunk.vertex_count() != 0;
}

}  // namespace

std::unique_ptr<ChunkSource> chunks_of(IndexedMesh& mesh, LastUse& last_use, FunctionValues& functions, ChunkSize size,
                                       const ChunkPlace& start) {
  return std::make_unique<IndexedChunks>(mesh, last_use, functions, size, start);
}

void WorkItem::shrink_to_fit() {
  chunk.ids.shrink_to_fit();
  chunk.uses.shrink_to_fit();
  chunk.positions.shrink_to_fit();
  chunk.corners.shrink_to_fit();
  for (auto& column : values) column.shrink_to_fit();
}

std::size_t WorkItem::memory_bytes() const {
  std::size_t bytes = chunk.ids.capacity() * sizeof(VertexId) + chunk.uses.capacity() +
                      chunk.positions.capacity() * sizeof(Point) + chunk.corners.capacity() * 4;
  for (const auto& column : values) bytes += column.capacity() * 8;
  for (const Fragment& fragment : fragments) bytes += fragment.memory_bytes();
  return bytes;
}

}  // namespace reeb::ooc
