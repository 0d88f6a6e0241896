#include "libreeb/base/error.h"
#include "ooc/chunks/batch_digest.h"
#include "ooc/chunks/chunk_growth.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/coherence.h"
#include "ooc/chunks/reader_memory.h"

namespace reeb::ooc {
namespace {

class StreamChunks : public ChunkSource {
 public:
  StreamChunks(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget, ChunkSize size,
               const ChunkPlace& start, std::optional<std::uint64_t> most_active_vertices)
      : reader_(reader),
        functions_(functions),
        size_(size),
        most_active_vertices_(most_active_vertices),
        chunker_(functions.function_count(), true),
        reader_memory_(budget),
        memory_(budget.reserve("vertices of the stream", 0)) {
    pass_over(start);
  }

  bool next(WorkItem& item) override;
  bool given_up() const override { return given_up_; }
  std::uint64_t bytes_read() const override { return reader_.bytes_read(); }
  std::uint64_t bytes_total() const override { return reader_.info().file_bytes; }
  std::uint64_t triangles_read() const override { return simplices_read_; }
  SimplexCounts simplices_listed() const override { return simplices_; }
  std::uint64_t vertex_count() const override { return vertices_; }
  std::uint64_t vertex_bound() const override { return chunker_.vertex_bound(); }

 private:
  void pass_over(const ChunkPlace& start);
  bool is_hopeless() const;
  bool hardly_finalizes() const;
  void read_batch();
  bool make_room();
  void add_vertices();

  MeshReader& reader_;
  FunctionValues& functions_;
  ChunkGrowth size_;                                   // in triangles
  std::optional<std::uint64_t> most_active_vertices_;  // set if it may give up
  StreamChunker chunker_;
  ReaderMemory reader_memory_;
  Reservation memory_;
  std::uint64_t simplices_read_ = 0, vertices_ = 0;
  SimplexCounts simplices_{};
  std::uint64_t batches_ = 0;
  BatchDigest digest_;
  bool ended_ = false, given_up_ = false;

  MeshBatch batch_;
  std::vector<Point> positions_;
  std::vector<std::vector<double>> values_;
  std::vector<double> row_;
};

bool StreamChunks::next(WorkItem& item) {
  while (!ended_ && !given_up_ && chunker_.chunk_size() < size_.size()) read_batch();
  if (given_up_ || chunker_.chunk_size() == 0) return false;
  chunker_.take(item.chunk, item.values);
  size_.adapt(item.chunk);
  item.end = {.triangles = simplices_read_,
              .next_vertex = chunker_.vertex_bound(),
              .batches = batches_,
              .chunk_blocks = size_.size(),
              .digest = digest_.value(),
              .ranges = functions_.ranges()};
  return true;
}

bool StreamChunks::is_hopeless() const {
  constexpr std::uint64_t kLargeMeshVertices = 1'000'000, kMeshShare = 8;
  if (!most_active_vertices_) return false;
  const std::uint64_t active = chunker_.active_vertices(), all = vertices_;
  return active > *most_active_vertices_ || (all > kLargeMeshVertices && active > all / kMeshShare) ||
         hardly_finalizes();
}

// In a coherent order, half of the vertices are final once two layers of a volume were used. If hardly any are, in a
// stream without finalization or in random order, nothing is complete before the end, and paths grow as long as the
// graph is large: of a random function on 85,000 vertices they took 11 GiB.
bool StreamChunks::hardly_finalizes() const {
  constexpr std::uint64_t kFinalShare = 8, kBytesPerVertex = 128;  // with its simplices, roughly
  const MeshInfo& info = reader_.info();
  const std::uint64_t used = chunker_.used_vertices();
  return used > usual_front_of_volume(info.vertex_count.value_or(info.file_bytes / kBytesPerVertex)) &&
         chunker_.final_vertices() < used / kFinalShare;
}

// Which vertices are live at a chunk's end, and which of them were used, does not depend on where the
// chunks before were cut.
void StreamChunks::pass_over(const ChunkPlace& start) {
  Chunk chunk;
  std::vector<std::vector<double>> values;
  while (!ended_ && !given_up_ && batches_ < start.batches) {
    read_batch();
    if (chunker_.chunk_size() >= size_.size() || batches_ == start.batches) chunker_.take(chunk, values);
  }
  if (given_up_) return;
  if (batches_ != start.batches || simplices_read_ != start.triangles || chunker_.vertex_bound() != start.next_vertex ||
      (batches_ != 0 && digest_.value() != start.digest))
    throw input_changed();
  if (start.chunk_blocks != 0) size_.set_size(static_cast<std::size_t>(start.chunk_blocks));
  if (!start.ranges.empty()) functions_.set_ranges(start.ranges);
}

void StreamChunks::read_batch() {
  ++batches_;
  if (!reader_.read(batch_)) {
    chunker_.finalize_all();
    ended_ = true;
    return;
  }
  digest_.add(batch_);
  reader_memory_.update(reader_);
  given_up_ = !make_room();
  if (given_up_) return;
  add_vertices();
  batch_.for_each_simplex([this](std::span<const VertexId> corners) { chunker_.add_simplex(corners); });
  batch_.add_counts(simplices_);
  simplices_read_ += batch_.simplex_count();
  for (const VertexId v : batch_.finalized) chunker_.finalize(v);
  memory_.resize(chunker_.memory_bytes());
  given_up_ = is_hopeless();
}

// Vertices that come long before their triangles are in no chunk yet. False if they are too many, and it may give up.
bool StreamChunks::make_room() {
  const std::uint64_t bytes = chunker_.memory_bytes_with(batch_.vertex_count);
  if (bytes <= memory_.bytes() || memory_.try_resize(bytes)) return true;
  if (!most_active_vertices_) memory_.resize(bytes);  // throws
  return false;
}

void StreamChunks::add_vertices() {
  const std::size_t n = batch_.vertex_count;
  if (n == 0) return;
  vertices_ += n;
  chunker_.skip_to(batch_.first_vertex);
  functions_.evaluate(batch_, positions_, values_);
  row_.resize(values_.size());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t f = 0; f < values_.size(); ++f) row_[f] = values_[f][i];
    chunker_.add_vertex(row_, positions_[i]);
  }
}

}  // namespace

std::unique_ptr<ChunkSource> chunks_of(MeshReader& reader, FunctionValues& functions, MemoryBudget& budget,
                                       ChunkSize size, const ChunkPlace& start,
                                       std::optional<std::uint64_t> most_active_vertices) {
  return std::make_unique<StreamChunks>(reader, functions, budget, size, start, most_active_vertices);
}

}  // namespace reeb::ooc
