#include "ooc/census/mesh_census.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <span>
#include <string>
#include <utility>

#include "libreeb/base/error.h"
#include "libreeb/containers/flat_map.h"
#include "ooc/census/first_places.h"
#include "ooc/census/live_surface.h"
#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/coherence.h"
#include "ooc/chunks/last_use.h"
#include "ooc/chunks/reader_memory.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/threads/read_ahead.h"
#include "ooc/whole_mesh/reorder.h"

namespace reeb::ooc {
namespace {

using Phase = CensusProgress::Phase;

constexpr const char* kOwner = "unfinished part of the surface";

void tell(const CensusOptions& options, const CensusProgress& progress) {
  if (options.progress) options.progress(progress);
}

bool has_cells(const SimplexCounts& counts) {
  return std::any_of(counts.begin() + 3, counts.end(), [](std::uint64_t count) { return count != 0; });
}

// ---- a mesh that can be looked up

struct CountedMesh {
  IndexedMesh& mesh;
  unsigned dimension;
  bool has_cells;
};

// How much of the budget the unfinished part may take before another order of the mesh is tried.
std::uint64_t most_live_bytes(const MemoryBudget& budget) {
  constexpr std::uint64_t kWithoutLimit = 256u << 20;
  return std::min(budget.free_bytes() / 2, kWithoutLimit);
}

// Whether the front is too large for the memory, or for the cache, and smaller along a curve.
bool should_sort(std::uint64_t front, std::uint64_t vertices, const MemoryBudget& budget) {
  constexpr std::uint64_t kVertexBytes = 400, kMostInCache = 65536, kShareOfRandomOrder = 8;
  if (front <= usual_front(vertices)) return false;
  const bool is_slow = front > kMostInCache && front > vertices / kShareOfRandomOrder;
  return is_slow || front > most_live_bytes(budget) / kVertexBytes;
}

LastUseOptions use_options(const IndexedMesh& mesh, const Workspace& space, const CensusOptions& options) {
  LastUseOptions uses;
  uses.allowance_bytes = 2 * space.share();
  // Blocks of one triangle give the exact front; for large meshes, blocks are doubled. Each time, the whole table is
  // read and written, so blocks begin at a size that they will reach: a mesh has more triangles than vertices.
  uses.most_blocks = 1u << 16;
  uses.block_triangles = std::max<std::uint64_t>(1, std::bit_floor(mesh.vertex_count() / uses.most_blocks));
  uses.threads = options.background ? 2 : 1;
  return uses;
}

// Nothing if the mesh is incoherent.
std::optional<LastUse> find_last_uses(IndexedMesh& mesh, Workspace& space, const CensusOptions& options) {
  LastUseOptions uses = use_options(mesh, space, options);
  uses.give_up_when_incoherent = true;
  uses.progress = [&](std::uint64_t bytes) { tell(options, {Phase::kFront, bytes, mesh.bytes_total(), 0}); };
  return scan_last_use(mesh, space.temp, space.budget, uses);
}

SortedMesh sorted(IndexedMesh& mesh, unsigned dimension, Workspace& space, const CensusOptions& options) {
  constexpr std::uint64_t kMostBytes = 64u << 20, kSteps = 10000;
  ReorderOptions reordering;
  reordering.allowance_bytes = std::min(space.budget.free_bytes() / 2, kMostBytes);
  reordering.coordinates = std::min(dimension, 3u);
  reordering.threads = options.background ? 2 : 1;
  reordering.progress = [&](double done) {
    tell(options, {Phase::kSort, static_cast<std::uint64_t>(done * kSteps), kSteps, 0});
  };
  return reorder_with_last_uses(mesh, space.temp, space.budget, reordering, use_options(mesh, space, options));
}

ChunkSize chunk_size(const MemoryBudget& budget, const CensusOptions& options) {
  if (options.chunk_triangles != 0) return {.first = options.chunk_triangles, .most = options.chunk_triangles};
  const auto share = [&](std::uint64_t part, std::uint64_t most) {
    return static_cast<std::size_t>(std::clamp<std::uint64_t>(budget.limit_bytes() / part, 1024, most));
  };
  return {.first = share(2048, 8192), .most = share(512, 131072)};
}

// Brings chunks to a surface.
class ChunkFeed {
 public:
  ChunkFeed(LiveSurface& surface, MemoryBudget& budget) : surface_(surface), memory_(budget.reserve(kOwner, 0)) {}

  // False if there is too little memory for what is unfinished afterwards.
  bool add(const Chunk& chunk) {
    slots_.resize(chunk.vertex_count());
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      slots_[i] = (chunk.uses[i] & kUsedEarlier) != 0 ? waiting_.find(chunk.ids[i].value()) : FlatMap::kNone;
      if (slots_[i] == FlatMap::kNone) slots_[i] = surface_.add_vertex(chunk.ids[i], chunk.positions[i]);
    }
    for (std::size_t t = 0; t < chunk.corners.size(); t += 3)
      surface_.add_triangle(slots_[chunk.corners[t]], slots_[chunk.corners[t + 1]], slots_[chunk.corners[t + 2]]);
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if ((chunk.uses[i] & kUsedLater) != 0) {
        waiting_.find_or_insert(chunk.ids[i].value(), slots_[i]);
        continue;
      }
      if ((chunk.uses[i] & kUsedEarlier) != 0) waiting_.erase(chunk.ids[i].value());
      surface_.finish(slots_[i]);
    }
    return memory_.try_resize(memory_bytes());
  }

  // THROWS: Error{kResource}, if add() returned false.
  void require_memory() { memory_.resize(memory_bytes()); }

 private:
  std::uint64_t memory_bytes() const {
    return surface_.memory_bytes() + waiting_.memory_bytes() + 4 * slots_.capacity();
  }

  LiveSurface& surface_;
  Reservation memory_;
  FlatMap waiting_;  // the slots of vertices that later chunks use
  std::vector<LiveSurface::Slot> slots_;
};

// Nothing if there is too little memory and it may give up.
std::optional<MeshCensus> count_chunks(const CountedMesh& counted, LastUse& uses, Workspace& space,
                                       const CensusOptions& options, bool may_give_up) {
  FunctionValues positions({}, counted.dimension);
  const auto source = chunks_of(counted.mesh, uses, positions, chunk_size(space.budget, options));
  LiveSurface surface;
  if (counted.has_cells) surface.count_components_only();
  ChunkFeed feed(surface, space.budget);
  std::atomic<bool> fits = true;  // the thread that reads asks for it
  struct Piece {
    WorkItem item;
    CensusProgress at{Phase::kCount};
  };
  const auto next = [&](Piece& piece) {
    if (!fits || !source->next(piece.item)) return false;
    piece.at = {Phase::kCount, source->bytes_read(), source->bytes_total(), source->triangles_read()};
    return true;
  };
  read_ahead<Piece>(options.background, next, [&](const Piece& piece) {
    if (!fits) return;
    fits = feed.add(piece.item.chunk);
    if (!fits && !may_give_up) feed.require_memory();
    tell(options, piece.at);
  });
  if (!fits) return std::nullopt;
  return surface.result();
}

MeshCensus count_indexed(const CountedMesh& counted, Workspace& space, const CensusOptions& options) {
  IndexedMesh& mesh = counted.mesh;
  std::optional<LastUse> uses = find_last_uses(mesh, space, options);
  std::optional<std::uint64_t> front;
  std::optional<MeshCensus> census;
  if (uses) {
    front = uses->summary().max_live_vertices;
    if (!should_sort(*front, mesh.vertex_count(), space.budget))
      census = count_chunks(counted, *uses, space, options, *front > usual_front(mesh.vertex_count()));
  }
  SimplexCounts simplices = mesh.simplex_counts();
  if (!census) {
    uses.reset();
    auto [other, uses_of_other] = sorted(mesh, counted.dimension, space, options);
    simplices = mesh.simplex_counts();
    census = count_chunks({*other, counted.dimension, counted.has_cells}, uses_of_other, space, options, false);
  }
  census->simplices = simplices;
  census->live_front = front;
  return std::move(*census);
}

// ---- a mesh that is read once

// The degenerate triangles of a mesh. Where it is spooled or indexed, edges and points have the same form.
class DegenerateTriangles {
 public:
  void add(const MeshBatch& batch) {
    const std::vector<VertexId>& corners = batch.triangles();
    for (std::size_t t = 0; t < corners.size(); t += 3) {
      const VertexId a = corners[t], b = corners[t + 1], c = corners[t + 2];
      if (a != b && b != c && a != c) [[likely]]
        continue;
      const VertexId other = b != a ? b : c;
      first_.add(other == a ? FirstPlaces::ascending(a) : FirstPlaces::ascending(a, other), {});
    }
  }

  CensusCount result(IndexedMesh& mesh, unsigned dimension) const {
    CensusCount result = first_.result();
    std::vector<unsigned> columns;
    for (unsigned k = 0; k < std::min(dimension, 3u); ++k) columns.push_back(k);
    std::vector<double> values;
    for (CensusPlace& place : result.places) {
      const std::size_t n = place.vertices.size();
      values.resize(columns.size() * n);
      mesh.gather(place.vertices, columns, values);
      for (std::size_t i = 0; i < values.size(); ++i) place.position[i / n] += values[i] / static_cast<double>(n);
    }
    return result;
  }

 private:
  FirstPlaces first_;
};

MeshCensus count_spooled(MeshReader& reader, Workspace& space, const CensusOptions& options) {
  const unsigned dimension = reader.info().dimension;
  SpooledMesh mesh(std::min(dimension, 3u), space.temp, space.budget, 2 * space.share());
  ReaderMemory reader_memory(space.budget);
  DegenerateTriangles degenerate;
  std::uint64_t simplices = 0;
  for (MeshBatch batch; reader.read(batch);) {
    if (options.observe) options.observe(batch);
    reader_memory.update(reader);
    degenerate.add(batch);
    simplices += batch.simplex_count();
    mesh.append(batch);
    tell(options, {Phase::kSpool, reader.bytes_read(), reader.info().file_bytes, simplices});
  }
  const bool cells = has_cells(mesh.simplex_counts());
  MeshCensus census = count_indexed({mesh, dimension, cells}, space, options);
  if (!cells) census.degenerate = degenerate.result(mesh, dimension);
  return census;
}

// Brings the batches of a stream that finalizes its vertices to a surface.
class StreamFeed {
 public:
  explicit StreamFeed(MemoryBudget& budget) : memory_(budget.reserve(kOwner, 0)) {}

  void count_components_only() { surface_.count_components_only(); }
  void add(const MeshBatch& batch) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      const VertexId id(batch.first_vertex.value() + i);
      slots_.find_or_insert(id.value(), surface_.add_vertex(id, batch.position(i)));
    }
    end_ = std::max(end_, batch.first_vertex.value() + batch.vertex_count);
    batch.for_each_simplex([this](std::span<const VertexId> corners) { add(corners); });
    for (const VertexId v : batch.finalized) finish(v);
  }

  // Finishes what the stream has not finalized.
  MeshCensus result() {
    for (std::uint64_t v = 0; v < end_ && slots_.size() != 0; ++v)
      if (slots_.find(v) != FlatMap::kNone) finish(VertexId(v));
    return surface_.result();
  }

  std::uint64_t memory_bytes() const { return surface_.memory_bytes() + slots_.memory_bytes(); }
  // Reserves what it holds. False if the budget does not have it.
  bool try_reserve() { return memory_.try_resize(memory_bytes()); }
  void reserve() { memory_.resize(memory_bytes()); }

 private:
  void add(std::span<const VertexId> corners) {
    corners_.clear();
    for (const VertexId v : corners) corners_.push_back(slot_of(v));
    switch (corners.size()) {
      case 1:
        return surface_.add_point(corners_[0]);
      case 2:
        return surface_.add_edge(corners_[0], corners_[1]);
      case 3:
        return surface_.add_triangle(corners_[0], corners_[1], corners_[2]);
      default:
        surface_.count_components_only();
        return surface_.add_cell(corners_);
    }
  }
  void finish(VertexId v) {
    surface_.finish(slot_of(v));
    slots_.erase(v.value());
  }
  LiveSurface::Slot slot_of(VertexId v) const {
    const LiveSurface::Slot slot = slots_.find(v.value());
    if (slot == FlatMap::kNone)
      throw Error(ErrorKind::kBadInput,
                  "vertex " + std::to_string(v.value()) + " is used before it comes, or after it was finalized",
                  "finalize a vertex once, after the last simplex that uses it");
    return slot;
  }

  LiveSurface surface_;
  Reservation memory_;
  FlatMap slots_;  // of vertices that are not final
  std::vector<LiveSurface::Slot> corners_;
  std::uint64_t end_ = 0;
};

struct StreamCensus {
  std::optional<MeshCensus> census;  // nothing if it gave up for lack of memory
  SimplexCounts simplices{};
  std::uint64_t front = 0;
};

// Reads the stream to its end in either case.
StreamCensus count_stream(MeshReader& reader, Workspace& space, const CensusOptions& options) {
  constexpr std::uint64_t kVerticesBetweenChecks = 4096;
  const bool may_give_up = options.read_again != nullptr;
  const std::uint64_t most_bytes = may_give_up ? most_live_bytes(space.budget) : ~std::uint64_t{0};
  StreamCensus result;
  std::optional<StreamFeed> feed(std::in_place, space.budget);
  if (reader.info().grid) feed->count_components_only();
  ReaderMemory reader_memory(space.budget);
  std::uint64_t live = 0, unchecked = 0, simplices = 0;
  for (MeshBatch batch; reader.read(batch);) {
    if (options.observe) options.observe(batch);
    reader_memory.update(reader);
    live += batch.vertex_count;
    result.front = std::max(result.front, live);
    live -= batch.finalized.size();
    batch.add_counts(result.simplices);
    simplices += batch.simplex_count();
    if (feed) feed->add(batch);
    unchecked += batch.vertex_count + batch.simplex_count();
    if (unchecked < kVerticesBetweenChecks) continue;
    unchecked = 0;
    if (feed && may_give_up && (feed->memory_bytes() > most_bytes || !feed->try_reserve())) feed.reset();
    if (feed) feed->reserve();
    tell(options, {Phase::kCount, reader.bytes_read(), reader.info().file_bytes, simplices});
  }
  if (feed) result.census = feed->result();
  return result;
}

MeshCensus count_read(MeshReader& reader, Workspace& space, const CensusOptions& options) {
  if (!reader.info().finalizes) return count_spooled(reader, space, options);
  StreamCensus stream = count_stream(reader, space, options);
  if (!stream.census)
    stream.census = count_spooled(
        *options.read_again(), space,
        {.background = options.background, .chunk_triangles = options.chunk_triangles, .progress = options.progress});
  stream.census->simplices = stream.simplices;
  stream.census->live_front = stream.front;
  return std::move(*stream.census);
}

}  // namespace

MeshCensus take_census(IndexedMesh& mesh, unsigned dimension, Workspace& space, const CensusOptions& options) {
  MeshCensus census = count_indexed({mesh, dimension, false}, space, options);
  const std::uint64_t others = census.simplices[0] + census.simplices[1];
  if (others == 0) return census;
  // Points and edges came in the form of degenerate triangles.
  if (!options.read_again) {
    census.degenerate.count -= others;
    census.degenerate.places.clear();
    return census;
  }
  DegenerateTriangles degenerate;
  const auto reader = options.read_again();
  for (MeshBatch batch; reader->read(batch);) degenerate.add(batch);
  census.degenerate = degenerate.result(mesh, dimension);
  return census;
}

MeshCensus take_census(MeshReader& reader, Workspace& space, const CensusOptions& options) {
  MeshCensus census = count_read(reader, space, options);
  if (reader.info().grid)
    census.not_a_surface = "it is an image";
  else if (has_cells(census.simplices))
    census.not_a_surface = "it has cells";
  if (!census.not_a_surface.empty()) census.why_no_genus = "it is not a surface: " + census.not_a_surface;
  return census;
}

}  // namespace reeb::ooc
