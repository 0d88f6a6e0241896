#include "ooc/chunks/last_use.h"

#include <algorithm>
#include <utility>

#include "ooc/threads/read_ahead.h"

namespace reeb::ooc {

namespace {

constexpr std::size_t kEntriesAtOnce = 16 << 10;
constexpr std::size_t kProfileSamples = 256;

// Calls visit(first, entries) for ranges of the table that together cover all used vertices below `count`.
template <class Visit>
void for_each_range(PagedTable<std::uint32_t>& table, std::uint64_t count, const Visit& visit) {
  std::vector<std::uint32_t> entries(kEntriesAtOnce);
  for (std::uint64_t first = 0; (first = table.next_set(first, count)) < count; first += kEntriesAtOnce) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(kEntriesAtOnce, count - first));
    table.read(first, std::span(entries).first(size));
    visit(first, std::span(entries).first(size));
  }
}

std::uint32_t halved(UseEntry entry) {
  if (entry.unused()) return UseEntry::kUnused;
  const std::uint32_t last = entry.last_block() / 2;
  if (entry.span() == UseEntry::kSaturatedSpan) return UseEntry(last, UseEntry::kSaturatedSpan).packed();
  return UseEntry(last, last - (entry.last_block() - entry.span()) / 2).packed();
}

// Triangles on their way from the mesh to the table.
struct TriangleBatch {
  std::vector<VertexId> corners;
  std::uint64_t bytes_read = 0;  // of the mesh, up to here
};

}  // namespace

LastUseScan::LastUseScan(std::uint64_t vertex_count, std::uint64_t triangles_by_size, const io::TempDir& temp,
                         MemoryBudget& budget, const LastUseOptions& options)
    : options_(options),
      table_("last uses", temp, budget, options.allowance_bytes, UseEntry::kUnused),
      most_blocks_(std::max<std::size_t>(2, options.most_blocks & ~1u)),
      block_triangles_(std::max<std::uint64_t>(1, options.block_triangles)),
      change_charge_(budget.reserve("last uses", 0)),
      triangles_by_size_(triangles_by_size) {
  summary_.vertex_count = vertex_count;
}

void LastUseScan::look_at(std::span<const VertexId> corners) {
  digest_.add(std::as_bytes(corners));
  for (std::size_t t = 0; t < corners.size(); t += 3)
    degenerate_ += corners[t] == corners[t + 1] || corners[t + 1] == corners[t + 2] || corners[t] == corners[t + 2];
}

void LastUseScan::use(std::span<const VertexId> corners, std::uint64_t bytes_read) {
  summary_.triangle_count += corners.size() / 3;
  while (!corners.empty() && !gave_up_) {
    if (in_block_ == 0) open_block();
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(corners.size() / 3, block_triangles_ - in_block_));
    use_in_block(corners.first(3 * count));
    corners = corners.subspan(3 * count);
    in_block_ += count;
    if (in_block_ == block_triangles_) close_block(bytes_read);
  }
}

void LastUseScan::open_block() {
  if (live_change_.size() == most_blocks_) double_blocks();
  if (live_change_.size() == live_change_.capacity()) {
    const std::size_t capacity = std::max<std::size_t>(1024, 2 * live_change_.size());
    change_charge_.resize(capacity * sizeof(std::int32_t));
    live_change_.reserve(capacity);
  }
  live_change_.push_back(0);
}

void LastUseScan::close_block(std::uint64_t bytes_read) {
  in_block_ = 0;
  gave_up_ = (options_.give_up_when_incoherent && table_.pages().is_thrashing()) ||
             carried_ / live_change_.size() > options_.most_live_vertices || is_scattered();
  if (!gave_up_ && options_.progress) options_.progress(bytes_read);
}

// Whether most corners so far were the first uses of their vertices, although a vertex has three uses or more on
// average. So most of these vertices will be used again.
bool LastUseScan::is_scattered() const {
  return triangles_by_size_ >= summary_.vertex_count && introduced_ > 2 * summary_.triangle_count &&
         introduced_ / 2 > options_.most_live_vertices;
}

void LastUseScan::use_in_block(std::span<const VertexId> corners) {
  const auto block = static_cast<std::uint32_t>(live_change_.size() - 1);
  std::int32_t introduced = 0;
  for (const VertexId v : corners) {
    std::uint32_t& entry = table_.change(v.value());
    const UseEntry before(entry);
    if (before.last_block() == block) continue;
    entry = before.used_by(block).packed();
    if (before.unused())
      ++introduced;
    else
      carried_ += block - before.last_block();
  }
  live_change_.back() += introduced;
  introduced_ += static_cast<std::uint64_t>(introduced);
}

// Joins blocks in pairs. A saturated span stays saturated.
void LastUseScan::double_blocks() {
  for_each_range(table_, summary_.vertex_count, [this](std::uint64_t first, std::span<std::uint32_t> entries) {
    for (std::uint32_t& packed : entries) packed = halved(UseEntry(packed));
    table_.write(first, entries);
  });
  for (std::size_t b = 0; b < live_change_.size() / 2; ++b)
    live_change_[b] = live_change_[2 * b] + live_change_[2 * b + 1];
  live_change_.resize(live_change_.size() / 2);
  carried_ /= 2;
  block_triangles_ *= 2;
}

LastUse LastUseScan::finish() {
  std::uint64_t used = 0;
  for_each_range(table_, summary_.vertex_count, [&](std::uint64_t, std::span<const std::uint32_t> entries) {
    for (const std::uint32_t packed : entries) {
      const UseEntry entry(packed);
      if (entry.unused()) continue;
      ++used;
      --live_change_[entry.last_block()];
    }
  });
  summary_.unused_vertices = summary_.vertex_count - used;
  summary_.degenerate_triangles = degenerate_;
  summary_.block_triangles = block_triangles_;
  summary_.block_count = live_change_.size();
  summary_.digest = digest_.value();
  profile_front();
  return {std::move(summary_), std::move(table_)};
}

void LastUseScan::profile_front() {
  const std::size_t blocks = live_change_.size();
  const std::size_t stretch = std::max<std::size_t>(1, (blocks + kProfileSamples - 1) / kProfileSamples);
  std::int64_t live = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    live += live_change_[b];
    if (b % stretch == 0) summary_.live_profile.push_back(0);
    auto& sample = summary_.live_profile.back();
    sample = std::max(sample, static_cast<std::uint64_t>(live));
    summary_.max_live_vertices = std::max(summary_.max_live_vertices, sample);
  }
}

std::optional<LastUse> scan_last_use(IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget,
                                     const LastUseOptions& options) {
  constexpr std::size_t kTrianglesAtOnce = 2048;
  LastUseScan scan(mesh.vertex_count(), mesh.triangles_by_size().value_or(0), temp, budget, options);
  const auto read = [&](TriangleBatch& batch) {
    if (scan.gave_up() || !mesh.read(batch.corners, kTrianglesAtOnce)) return false;
    batch.bytes_read = mesh.bytes_read();
    scan.look_at(batch.corners);
    return true;
  };
  mesh.rewind();
  read_ahead<TriangleBatch>(options.threads > 1, read,
                            [&](const TriangleBatch& batch) { scan.use(batch.corners, batch.bytes_read); });
  if (scan.gave_up()) return std::nullopt;
  return scan.finish();
}

}  // namespace reeb::ooc
