#include "ooc/memory_plan.h"

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
constexpr std::uint64_t kLeast = 16 * kMiB;

// Measured: a live vertex with its edges, arcs and references, vectors with room to grow.
constexpr std::uint64_t kBytesALiveVertex = 900;
// Measured a triangle: scratch of a sweep, and a chunk in flight with its fragment.
constexpr std::uint64_t kSweepBytes = 80, kFlightBytes = 130;
// Below this account one thread: chunks of a useful size come before parallel ones.
constexpr std::uint64_t kEnoughForThreads = 12 * kMiB;
// Chunks are for so many threads, however many there are: an embedding shows where they were cut.
constexpr std::uint64_t kPlannedThreads = 2;

std::uint64_t bytes_a_triangle(std::uint64_t threads, std::size_t functions) {
  const std::uint64_t in_flight = threads == 1 ? 1 : threads + 1;
  return threads * kSweepBytes + in_flight * kFlightBytes * functions;
}

std::uint64_t machine_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : 1024 * kMiB;
}

}  // namespace

std::uint64_t MemoryPlan::most_live_vertices() const { return live_bytes / kBytesALiveVertex; }

MemoryPlan plan_memory(std::uint64_t limit_bytes, unsigned threads, std::size_t functions,
                       std::size_t chunk_triangles, bool in_place) {
  if (limit_bytes < kLeast)
    throw Error(ErrorKind::kResource, "a run needs at least " + format_bytes(kLeast) + " of memory, but only " +
                                          format_bytes(limit_bytes) + " are allowed",
                "allow more, for instance --memory 32M");
  const std::uint64_t limit = limit_bytes == MemoryBudget::kUnlimited ? machine_bytes() / 2 : limit_bytes;
  MemoryPlan plan;
  plan.set_aside_bytes = kProcess + (in_place ? kWindows : 0);
  plan.account_bytes = limit - plan.set_aside_bytes;
  // Beyond these sizes more memory makes nothing faster. The live graph gets what nobody else
  // takes; the front that is planned for leaves it room.
  const std::uint64_t eighth = plan.account_bytes / 8;
  plan.table_bytes = std::min(eighth / 2, 3 * kMiB);
  plan.segment_bytes = std::min(eighth / 2, 2 * kMiB) / functions;
  plan.live_bytes = std::min(4 * eighth, 96 * kMiB) / functions;

  const bool alone = plan.account_bytes < kEnoughForThreads;
  const std::uint64_t share = std::min(eighth, 64 * kMiB);
  const auto most = static_cast<std::size_t>(
      std::max<std::uint64_t>(512, share / bytes_a_triangle(alone ? 1 : kPlannedThreads, functions)));
  plan.chunk.first = std::min(plan.chunk.first, most);
  plan.chunk.most = std::min(plan.chunk.most, most);
  plan.threads = alone ? 1 : threads;
  while (plan.threads > kPlannedThreads && bytes_a_triangle(plan.threads, functions) * most > 2 * eighth) --plan.threads;
  if (chunk_triangles != 0) plan.chunk = {chunk_triangles, chunk_triangles};
  return plan;
}

}  // namespace reeb::ooc
