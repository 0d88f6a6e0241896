#include "ooc/run/memory_plan.h"

#include <unistd.h>

#include <algorithm>
#include <string>

#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/threads/work_in_order.h"

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;
// The largest measured values: code, allocator and stacks; and windows of a mesh that is looked up in place.
constexpr std::uint64_t kProcess = 31 * kMiB / 4, kWindows = kMiB;
constexpr std::uint64_t kSmallestBudget = 16 * kMiB;
// In addition, memory that the allocator cannot use again. The smallest budget has nothing to spare for it.
constexpr std::uint64_t kFragmentation = 3 * kMiB;

// Bytes per live vertex, with its share of edges, arcs and references and with room to grow. Scans of 4 to 372 million
// triangles, f = z, took 290 to 640 bytes with noise removed and 470 to 690 with noise kept; a wider front took more.
// Buckets added 85 to 340. A random function takes up to 1,390: if a run on one does not fit, it ends with what
// --resume needs.
constexpr std::uint64_t kSmooth = 290, kNoiseRemoved = 640, kNoiseKept = 700;
constexpr std::uint64_t kBucketsSmooth = 85, kBucketsRemoved = 185, kBucketsKept = 340;

// What live graphs and chunks take together where memory is free. Chunks of a wide front are smaller, down to
// kUsefulTriangles, which costs a few per cent of the time.
constexpr std::uint64_t kUsualForLiveAndChunks = 16 * kMiB;
constexpr std::size_t kUsefulTriangles = 16384;
// Of a patch of a stretch. Larger ones take memory and save nothing.
constexpr std::size_t kPatchTriangles = 12288;

// Measured bytes per triangle: scratch memory of a sweep; a chunk in flight with its fragment; what the source keeps;
// and, for a stretch that is cut into chunks, its storage and what reading and cutting it takes.
constexpr std::uint64_t kSweepBytes = 90, kFlightBytes = 55, kSourceBytes = 20, kStretchBytes = 50;
// The same per vertex, where a triangle has three of its own: many per triangle, so that triangles count for little.
constexpr std::uint64_t kSweepVertexBytes = 170, kFlightVertexBytes = 125, kSourceVertexBytes = 63,
                        kStretchVertexBytes = 72;
// More memory than this for chunks makes a run hardly faster.
constexpr std::uint64_t kUsefulChunkBytes = 64 * kMiB;
constexpr std::size_t kSmallestChunk = 512;
// A chunk that a user chose takes at least this much per triangle, so a larger one than fits the budget is not tried.
constexpr std::uint64_t kLeastTriangleBytes = 40;
// One thread with a budget below this: chunks of a useful size matter more than parallel ones.
constexpr std::uint64_t kEnoughForThreads = 12 * kMiB;
// Chunks are sized for this many threads, however many there are: an embedding shows where chunks were cut.
constexpr unsigned kPlannedThreads = 2;

// Bytes per triangle of a chunk with this many threads, each of which can sweep a chunk.
std::uint64_t chunk_bytes(unsigned threads, std::size_t functions) {
  return threads * kSweepBytes + items_for(threads) * functions * kFlightBytes + kSourceBytes;
}

// The same per vertex.
std::uint64_t chunk_vertex_bytes(unsigned threads, std::size_t functions) {
  return threads * kSweepVertexBytes + items_for(threads) * functions * kFlightVertexBytes + kSourceVertexBytes;
}

std::uint64_t machine_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : 1024 * kMiB;
}

std::uint64_t saturating_minus(std::uint64_t a, std::uint64_t b) { return a - std::min(a, b); }

}  // namespace

MemoryPlan plan_memory(const MemoryRequest& request) {
  const std::uint64_t limit =
      request.limit_bytes == MemoryBudget::kUnlimited ? machine_bytes() / 2 : request.limit_bytes;
  if (limit < kSmallestBudget)
    throw Error(
        ErrorKind::kResource,
        "a run needs at least " + format_bytes(kSmallestBudget) + " of memory, but may use only " + format_bytes(limit),
        "allow more, for instance --memory 32M")
        .because(ErrorCause::kMemory);
  if (limit < kSmallestBudget + request.reader_bytes) {
    const std::string megabytes = std::to_string(((kSmallestBudget + request.reader_bytes) >> 20) + 1) + "M";
    throw Error(ErrorKind::kResource,
                "unpacking the input takes " + format_bytes(request.reader_bytes) + ", and the run at least " +
                    format_bytes(kSmallestBudget) + ", but they may use only " + format_bytes(limit),
                "allow --memory " + megabytes + ", or unpack the input first")
        .because(ErrorCause::kMemory);
  }
  MemoryPlan plan;
  plan.request_ = request;
  plan.set_aside_bytes = kProcess + (request.in_place ? kWindows : 0) + request.reader_bytes +
                         std::min(kFragmentation, (limit - kSmallestBudget - request.reader_bytes) / 4);
  plan.budget_bytes = limit - plan.set_aside_bytes;
  // Beyond these sizes, more memory makes nothing faster.
  plan.table_bytes = std::min(plan.budget_bytes / 16, kMiB);
  plan.segment_bytes = std::min(plan.budget_bytes / 16, kMiB) / request.functions;
  plan.most_segment_bytes = std::min(plan.budget_bytes / 32, 16 * kMiB) / request.functions;
  const std::uint64_t graph = request.denoises ? kNoiseRemoved : kNoiseKept;
  const std::uint64_t buckets = request.denoises ? kBucketsRemoved : kBucketsKept;
  plan.vertex_bytes_ = request.functions * (graph + (request.embeds ? buckets : 0));
  plan.least_vertex_bytes_ = request.functions * (kSmooth + (request.embeds ? kBucketsSmooth : 0));
  plan.size_chunks(plan.budget_bytes / 6, ChunkSize{}.first);  // until the front is known
  return plan;
}

std::uint64_t MemoryPlan::taken_bytes(const FrontNeeds& needs) const {
  const std::uint64_t directory = 4 * needs.vertices / 1024;  // of the table of last uses
  return (request_.in_place ? 1 : 2) * table_bytes + directory + request_.functions * segment_bytes +
         needs.function_bytes + needs.order_bytes;
}

// What the smallest chunks leave for the live graphs.
std::uint64_t MemoryPlan::live_room(const FrontNeeds& needs) const {
  return saturating_minus(budget_bytes, taken_bytes(needs) + kSmallestChunk * triangle_bytes());
}

bool MemoryPlan::fits(const FrontNeeds& needs) const {
  return needs.live_vertices * vertex_bytes_ <= saturating_minus(live_room(needs), budget_bytes / 16);
}

bool MemoryPlan::exceeds(const FrontNeeds& needs) const {
  return needs.live_vertices * least_vertex_bytes_ > live_room(needs);
}

std::uint64_t MemoryPlan::most_live_vertices() const {
  return saturating_minus(live_room({}), budget_bytes / 16) / vertex_bytes_;
}

std::uint64_t MemoryPlan::needed_bytes(const FrontNeeds& needs) const {
  const std::uint64_t fixed = taken_bytes(needs) + kSmallestChunk * triangle_bytes();
  return set_aside_bytes + (fixed + needs.live_vertices * vertex_bytes_) / 15 * 16;
}

bool MemoryPlan::allows_threads() const { return budget_bytes >= kEnoughForThreads; }

std::uint64_t MemoryPlan::triangle_bytes() const {
  return chunk_bytes(allows_threads() ? kPlannedThreads : 1, request_.functions);
}

std::size_t MemoryPlan::box_triangles() const {
  constexpr std::uint64_t kShare = 24;  // of the budget
  if (request_.chunk_triangles != 0) return chunk.first;
  return static_cast<std::size_t>(
      std::clamp<std::uint64_t>(budget_bytes / kShare / triangle_bytes(), chunk.first, 4 * chunk.first));
}

// A rough function takes up to twice as much for the live graph, so half of the room stays free.
void MemoryPlan::share_out(const FrontNeeds& needs) {
  const std::uint64_t live = needs.live_vertices * vertex_bytes_;
  const std::uint64_t room = saturating_minus(budget_bytes, taken_bytes(needs) + live);
  const std::uint64_t usual = saturating_minus(kUsualForLiveAndChunks, live) / triangle_bytes();
  size_chunks(std::max(budget_bytes / 8, room / 2), std::max<std::size_t>(usual, kUsefulTriangles));
}

// The patches of a stretch take a quarter of the memory at most, so that the stretch can be long. Larger ones would
// make nothing faster: the border that they save is within the stretch.
void MemoryPlan::size_chunks(std::uint64_t bytes, std::size_t most_triangles) {
  const std::uint64_t room = bytes;
  bytes = std::min(bytes, allows_threads() ? kUsefulChunkBytes : budget_bytes / 10);
  chunk = {};
  const auto fitting = [&](std::uint64_t part) {
    return std::clamp(static_cast<std::size_t>(part / triangle_bytes()), kSmallestChunk,
                      std::min(ChunkSize{}.first, most_triangles));
  };
  chunk.first = fitting(bytes);
  chunk.patch = std::min(fitting(bytes / 4), kPatchTriangles);
  const auto stretch =
      static_cast<std::size_t>(saturating_minus(bytes, chunk.patch * triangle_bytes()) / kStretchBytes);
  chunk.most = std::clamp(stretch, chunk.first, chunk.most);
  // Usually a triangle has half a vertex, and these limits change nothing; nor do they where memory is free.
  const std::uint64_t vertex = chunk_vertex_bytes(allows_threads() ? kPlannedThreads : 1, request_.functions);
  chunk.first_vertices = std::max(chunk.first, static_cast<std::size_t>(room / vertex));
  chunk.most_vertices =
      std::max(chunk.most,
               static_cast<std::size_t>(saturating_minus(room, chunk.patch * triangle_bytes()) / kStretchVertexBytes));
  threads = allows_threads() ? request_.threads : 1;
  const std::uint64_t parallel = std::max(bytes, budget_bytes / 4);
  while (threads > kPlannedThreads && chunk_bytes(threads, request_.functions) * chunk.first > parallel) --threads;
  if (request_.chunk_triangles != 0) {
    const std::uint64_t fitting_triangles = std::max<std::uint64_t>(kSmallestChunk, budget_bytes / kLeastTriangleBytes);
    chunk.first = chunk.patch =
        static_cast<std::size_t>(std::min<std::uint64_t>(request_.chunk_triangles, fitting_triangles));
    chunk.most = std::max(chunk.first, request_.stretch_triangles);
  }
}

}  // namespace reeb::ooc
