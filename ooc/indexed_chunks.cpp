#include <algorithm>
#include <cmath>

#include "ooc/chunk_source.h"
#include "ooc/local_numbers.h"

namespace reeb::ooc {
namespace {

// Grow above this share of shared vertices, shrink below a quarter of it. A shared vertex brings
// about one shared edge, of three in all, so this is a tenth of the edges.
constexpr double kManyShared = 0.30;

class IndexedChunks : public ChunkSource {
 public:
  IndexedChunks(IndexedMesh& mesh, LastUse& last_use, FunctionValues& columns, ChunkSize size,
                const ChunkPlace& start)
      : mesh_(mesh),
        last_use_(last_use),
        columns_(columns),
        size_(size),
        block_triangles_(static_cast<std::size_t>(last_use.summary().block_triangles)),
        blocks_(std::max<std::size_t>(1, size.first / std::max<std::size_t>(1, block_triangles_))) {
    mesh_.rewind();
    pass_over(start);
  }

  bool next(WorkItem& item) override;
  std::uint64_t bytes_read() const override { return mesh_.bytes_read(); }
  std::uint64_t bytes_total() const override { return mesh_.bytes_total(); }
  std::uint64_t triangles_read() const override { return triangles_read_; }
  std::uint64_t vertex_count() const override { return mesh_.vertex_count(); }

 private:
  void pass_over(const ChunkPlace& start);
  bool read_triangles(WorkItem& item);
  bool read_loose_vertices(Chunk& chunk);
  void set_uses(Chunk& chunk);
  void look_up(WorkItem& item);
  void adapt(WorkItem& item);

  IndexedMesh& mesh_;
  LastUse& last_use_;
  FunctionValues& columns_;
  ChunkSize size_;
  std::size_t block_triangles_;
  std::size_t blocks_;             // of the next chunk
  std::uint64_t first_block_ = 0;  // of the next chunk
  std::uint64_t triangles_read_ = 0;
  std::uint64_t next_vertex_ = 0;  // from which on unused vertices are looked for

  std::vector<VertexId> corners_;
  LocalNumbers numbers_;
  std::vector<std::uint32_t> entries_;
  std::vector<double> gathered_;
  std::vector<std::span<const double>> data_;
};

bool IndexedChunks::next(WorkItem& item) {
  item.chunk.clear();
  item.sweep_alone = false;
  if (!read_triangles(item) && !read_loose_vertices(item.chunk)) return false;
  look_up(item);
  item.end.triangles = triangles_read_;
  item.end.next_vertex = next_vertex_;
  item.end.chunk_blocks = blocks_;
  item.end.ranges.assign(columns_.ranges().begin(), columns_.ranges().end());
  return true;
}

void IndexedChunks::pass_over(const ChunkPlace& start) {
  constexpr std::uint64_t kPiece = 65536;
  while (triangles_read_ < start.triangles &&
         mesh_.read(corners_, static_cast<std::size_t>(std::min(kPiece, start.triangles - triangles_read_))))
    triangles_read_ += corners_.size() / 3;
  first_block_ = triangles_read_ / block_triangles_;
  next_vertex_ = start.next_vertex;
  if (start.chunk_blocks != 0) blocks_ = static_cast<std::size_t>(start.chunk_blocks);
  if (!start.ranges.empty()) columns_.set_ranges(start.ranges);
}

// In pieces, so that corners are numbered while they are in the first cache.
bool IndexedChunks::read_triangles(WorkItem& item) {
  Chunk& chunk = item.chunk;
  constexpr std::size_t kPiece = 1024;
  const std::size_t most = blocks_ * block_triangles_;
  numbers_.start(chunk.ids, most);
  chunk.corners.resize(3 * most);
  std::size_t count = 0;
  while (count < most && mesh_.read(corners_, std::min(kPiece, most - count))) {
    numbers_.number(corners_, std::span(chunk.corners).subspan(3 * count, corners_.size()));
    count += corners_.size() / 3;
  }
  if (count == 0) return false;
  chunk.corners.resize(3 * count);
  triangles_read_ += count;
  set_uses(chunk);
  first_block_ += blocks_;
  adapt(item);
  return true;
}

void IndexedChunks::set_uses(Chunk& chunk) {
  entries_.resize(chunk.vertex_count());
  last_use_.lookup(chunk.ids, entries_);
  const std::uint64_t last_block = first_block_ + blocks_ - 1;
  chunk.uses.resize(chunk.vertex_count());
  for (std::size_t i = 0; i < chunk.vertex_count(); ++i) {
    const UseEntry entry(entries_[i]);
    // A saturated span says earlier than it may be, which is allowed.
    const bool earlier = entry.last_block() < first_block_ + entry.span() || entry.span() == UseEntry::kManyBlocks;
    const bool later = entry.last_block() > last_block;
    chunk.uses[i] = static_cast<std::uint8_t>((earlier ? kUsedEarlier : 0) | (later ? kUsedLater : 0));
  }
}

void IndexedChunks::adapt(WorkItem& item) {
  const auto& uses = item.chunk.uses;
  const auto shared = static_cast<double>(
      std::count_if(uses.begin(), uses.end(), [](std::uint8_t u) { return u != kUsedHereOnly; }));
  const auto all = static_cast<double>(item.chunk.vertex_count());
  const auto triangles = static_cast<double>(item.chunk.triangle_count());
  const auto allowance = static_cast<double>(size_.allowance_bytes);
  item.sweep_alone = size_.parallel.bytes(triangles, shared) > allowance;
  const std::size_t least = std::max<std::size_t>(1, size_.first / block_triangles_);
  const std::size_t most = std::max<std::size_t>(1, size_.most / block_triangles_);
  if (least == most) return;
  const auto before = static_cast<double>(blocks_);
  if (shared > kManyShared * all && blocks_ < most)
    blocks_ = std::min(2 * blocks_, most);
  else if (shared < kManyShared / 4 * all && blocks_ > least)
    blocks_ = std::max(blocks_ / 2, least);
  // The border of a chunk grows as the root of its area.
  const auto fits = [&](std::size_t blocks) {
    const double area = static_cast<double>(blocks) / before;
    return size_.alone.bytes(triangles * area, shared * std::sqrt(area)) <= allowance;
  };
  while (blocks_ > 1 && !fits(blocks_)) --blocks_;
}

bool IndexedChunks::read_loose_vertices(Chunk& chunk) {
  constexpr std::size_t kBatch = 16384;
  const std::uint64_t count = mesh_.vertex_count();
  if (last_use_.summary().unused_vertices == 0) return false;
  while (next_vertex_ < count && chunk.vertex_count() < kBatch) {
    entries_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBatch, count - next_vertex_)));
    last_use_.read(VertexId(next_vertex_), entries_);
    for (const std::uint32_t entry : entries_) {
      if (UseEntry(entry).unused()) chunk.ids.push_back(VertexId(next_vertex_));
      ++next_vertex_;
    }
  }
  chunk.uses.assign(chunk.vertex_count(), kUsedHereOnly);
  return chunk.vertex_count() != 0;
}

void IndexedChunks::look_up(WorkItem& item) {
  const std::size_t n = item.chunk.vertex_count();
  gathered_.resize(n * columns_.columns().size());
  mesh_.gather(item.chunk.ids, columns_.columns(), gathered_);
  data_.clear();
  for (std::size_t k = 0; k < columns_.columns().size(); ++k) data_.emplace_back(gathered_.data() + k * n, n);
  mesh_.to_original(item.chunk.ids);
  columns_.evaluate(item.chunk.ids, data_, item.chunk.positions, item.values);
}

}  // namespace

std::unique_ptr<ChunkSource> chunks_of(IndexedMesh& mesh, LastUse& last_use, FunctionValues& columns,
                                       ChunkSize size, const ChunkPlace& start) {
  return std::make_unique<IndexedChunks>(mesh, last_use, columns, size, start);
}

std::size_t WorkItem::memory_bytes() const {
  std::size_t bytes = chunk.ids.capacity() * sizeof(VertexId) + chunk.uses.capacity() +
                      chunk.positions.capacity() * sizeof(Point) + chunk.corners.capacity() * 4;
  for (const auto& column : values) bytes += column.capacity() * 8;
  for (const Fragment& fragment : fragments) bytes += fragment.memory_bytes();
  return bytes;
}

}  // namespace reeb::ooc
