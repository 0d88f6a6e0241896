#include "ooc/run/memory_plan.h"

#include <unistd.h>

#include <algorithm>
#include <string>

#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;
// Measured, at most: code, allocator and stacks; and windows of a mesh that is looked up in place.
constexpr std::uint64_t kProcess = 8 * kMiB, kWindows = kMiB;
constexpr std::uint64_t kLeastBudget = 16 * kMiB;
// Besides, what the allocator cannot use again: of the least budget nothing can be spared for it.
constexpr std::uint64_t kUnused = 2 * kMiB;

// A live vertex with its share of edges, arcs and references, room to grow included. Scans of 4 to 372
// million triangles, f = z, took 290 to 640 bytes with noise removed and 470 to 690 with it kept, the
// more the wider the front; buckets made 70 to 300 more of it. A random function takes up to 1,350:
// a run on one that does not fit ends with what --resume needs.
constexpr std::uint64_t kSmooth = 290, kNoiseRemoved = 640, kNoiseKept = 700;
constexpr std::uint64_t kBucketsSmooth = 70, kBucketsRemoved = 160, kBucketsKept = 300;

// What live graphs and chunks take together where memory is free: chunks of a wide front are smaller,
// which costs a few per cent of the time, down to kUsefulTriangles.
constexpr std::uint64_t kUsualForLiveAndChunks = 16 * kMiB;
constexpr std::size_t kUsefulTriangles = 12288;

// Measured a triangle: scratch of a sweep, a chunk in flight with its fragment, and what the source
// keeps; and of a stretch that is cut into chunks, as it lies there and while it is read and cut.
constexpr std::uint64_t kSweepBytes = 90, kFlightBytes = 55, kSourceBytes = 20, kStretchBytes = 50;
// Beyond this more memory for chunks makes little faster.
constexpr std::uint64_t kMostForChunks = 64 * kMiB;
constexpr std::size_t kLeastTriangles = 512;
// Below this account one thread: chunks of a useful size come before parallel ones.
constexpr std::uint64_t kEnoughForThreads = 12 * kMiB;
// Chunks are for so many threads, however many there are: an embedding shows where they were cut.
constexpr std::uint64_t kPlannedThreads = 2;

// A triangle of a chunk, with so many swept at a time, and one more in flight where there are several.
std::uint64_t chunk_bytes(std::uint64_t threads, std::size_t functions) {
  return threads * kSweepBytes + (threads == 1 ? 1 : threads + 1) * functions * kFlightBytes + kSourceBytes;
}

std::uint64_t machine_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : 1024 * kMiB;
}

std::uint64_t saturating_minus(std::uint64_t a, std::uint64_t b) { return a - std::min(a, b); }

}  // namespace

MemoryPlan plan_memory(const MemoryRequest& request) {
  if (request.limit_bytes < kLeastBudget)
    throw Error(ErrorKind::kResource,
                "a run needs at least " + format_bytes(kLeastBudget) + " of memory, but only " +
                    format_bytes(request.limit_bytes) + " is allowed",
                "allow more, for instance --memory 32M");
  const std::uint64_t limit =
      request.limit_bytes == MemoryBudget::kUnlimited ? machine_bytes() / 2 : request.limit_bytes;
  MemoryPlan plan;
  plan.request_ = request;
  plan.set_aside_bytes = kProcess + (request.in_place ? kWindows : 0) + std::min(kUnused, (limit - kLeastBudget) / 4);
  plan.account_bytes = limit - plan.set_aside_bytes;
  // Beyond these sizes more memory makes nothing faster.
  plan.table_bytes = std::min(plan.account_bytes / 16, kMiB);
  plan.segment_bytes = std::min(plan.account_bytes / 16, kMiB) / request.functions;
  plan.most_segment_bytes = std::min(plan.account_bytes / 32, 16 * kMiB) / request.functions;
  const std::uint64_t graph = request.denoises ? kNoiseRemoved : kNoiseKept;
  const std::uint64_t buckets = request.denoises ? kBucketsRemoved : kBucketsKept;
  plan.vertex_bytes_ = request.functions * (graph + (request.embeds ? buckets : 0));
  plan.least_vertex_bytes_ = request.functions * (kSmooth + (request.embeds ? kBucketsSmooth : 0));
  plan.size_chunks(plan.account_bytes / 6, ChunkSize{}.first);  // until the front is known
  return plan;
}

std::uint64_t MemoryPlan::taken_bytes(const FrontNeeds& needs) const {
  const std::uint64_t directory = 4 * needs.vertices / 1024;  // of the table of last uses
  return (request_.in_place ? 1 : 2) * table_bytes + directory + request_.functions * segment_bytes +
         needs.function_bytes;
}

// What the least chunks leave for the live graphs.
std::uint64_t MemoryPlan::live_room(const FrontNeeds& needs) const {
  return saturating_minus(account_bytes, taken_bytes(needs) + kLeastTriangles * triangle_bytes());
}

bool MemoryPlan::fits(const FrontNeeds& needs) const {
  return needs.live_vertices * vertex_bytes_ <= saturating_minus(live_room(needs), account_bytes / 16);
}

bool MemoryPlan::exceeds(const FrontNeeds& needs) const {
  return needs.live_vertices * least_vertex_bytes_ > live_room(needs);
}

std::uint64_t MemoryPlan::most_live_vertices() const {
  return saturating_minus(live_room({}), account_bytes / 16) / vertex_bytes_;
}

std::uint64_t MemoryPlan::needed_bytes(const FrontNeeds& needs) const {
  const std::uint64_t fixed = taken_bytes(needs) + kLeastTriangles * triangle_bytes();
  return set_aside_bytes + (fixed + needs.live_vertices * vertex_bytes_) / 15 * 16;
}

bool MemoryPlan::allows_threads() const { return account_bytes >= kEnoughForThreads; }

std::uint64_t MemoryPlan::triangle_bytes() const {
  return chunk_bytes(allows_threads() ? kPlannedThreads : 1, request_.functions);
}

// A rough function takes up to twice as much for the live graph; so half of the room is left.
void MemoryPlan::share_out(const FrontNeeds& needs) {
  const std::uint64_t live = needs.live_vertices * vertex_bytes_;
  const std::uint64_t room = saturating_minus(account_bytes, taken_bytes(needs) + live);
  const std::uint64_t usual = saturating_minus(kUsualForLiveAndChunks, live) / triangle_bytes();
  size_chunks(std::max(account_bytes / 8, room / 2), std::max<std::size_t>(usual, kUsefulTriangles));
}

// Patches of a stretch take a quarter, so that it can be long.
void MemoryPlan::size_chunks(std::uint64_t bytes, std::size_t most_triangles) {
  bytes = std::min(bytes, allows_threads() ? kMostForChunks : account_bytes / 10);
  chunk = {};
  const auto fitting = [&](std::uint64_t part) {
    return std::clamp(static_cast<std::size_t>(part / triangle_bytes()), kLeastTriangles,
                      std::min(ChunkSize{}.first, most_triangles));
  };
  chunk.first = fitting(bytes);
  chunk.patch = fitting(bytes / 4);
  const auto stretch =
      static_cast<std::size_t>(saturating_minus(bytes, chunk.patch * triangle_bytes()) / kStretchBytes);
  chunk.most = std::clamp(stretch, chunk.first, chunk.most);
  threads = allows_threads() ? request_.threads : 1;
  const std::uint64_t parallel = std::max(bytes, account_bytes / 4);
  while (threads > kPlannedThreads && chunk_bytes(threads, request_.functions) * chunk.first > parallel) --threads;
  if (request_.chunk_triangles != 0) {
    chunk.first = chunk.patch = request_.chunk_triangles;
    chunk.most = std::max(request_.chunk_triangles, request_.stretch_triangles);
  }
}

}  // namespace reeb::ooc
