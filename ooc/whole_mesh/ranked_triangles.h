// Triangles sorted by their corners, which are numbers from 0 to the number of vertices.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/tables/partition_logs.h"
#include "ooc/threads/read_ahead.h"
#include "ooc/threads/worker.h"

namespace reeb::ooc {

template <class Rank>
struct RankedTriangle {
  std::array<Rank, 3> corners;  // rotated so that the lowest is first, not flipped
  friend auto operator<=>(const RankedTriangle&, const RankedTriangle&) = default;

  // Without branches, since they could not be predicted.
  static RankedTriangle of(const std::array<Rank, 3>& ranks) {
    const std::size_t of_two = ranks[1] < ranks[0] ? 1 : 0;
    const std::size_t lowest = ranks[2] < ranks[of_two] ? 2 : of_two;
    return {{ranks[lowest], ranks[(lowest + 1) % 3], ranks[(lowest + 2) % 3]}};
  }
};

// Triangles are divided by their lowest corner into parts on disk, each of which is then sorted in memory by counting:
// no comparison but among the triangles of a vertex. A part that is too large, since some vertices have most of the
// triangles, is sorted on disk; and so are all, if memory is too small for the parts.
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: the allowance of the sort, reserved as it is needed, and as much again for each of up to two large parts.
// THREADS: each lane is for one thread at a time; else one at a time.
template <class Rank>
class RankedTriangles {
 public:
  using Triangle = RankedTriangle<Rank>;

  RankedTriangles(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t vertices, std::size_t lanes,
                  const SortOptions& sorting)
      : temp_(temp), budget_(budget), sorting_(sorting) {
    constexpr std::uint64_t kLeastEntries = 4096, kParts = 64;
    part_bits_ = static_cast<unsigned>(std::bit_width(std::max(kLeastEntries, vertices / kParts)) - 1);
    parts_ = static_cast<std::size_t>((vertices >> part_bits_) + 1);
    const std::uint64_t parts = lanes * parts_;
    const bool has_room = parts * Logs::kLargeBlockBytes <= sorting.allowance_bytes / 4;
    const std::size_t block_bytes = has_room ? Logs::kLargeBlockBytes : Logs::kBlockBytes;
    const std::uint64_t logs = parts * block_bytes;
    if (logs + kUsualTriangles * part_entries() * kTriangleBytes > sorting.allowance_bytes) {
      all_.emplace("reorder", temp, budget, sorting);
      return;
    }
    sorting_.allowance_bytes -= logs;
    for (std::size_t lane = 0; lane < lanes; ++lane) logs_.emplace_back("reorder", temp, budget, parts_, block_bytes);
  }

  void add(std::size_t lane, std::span<const Triangle> triangles) {
    if (all_) {
      const std::lock_guard lock(mutex_);
      all_->add(triangles);
      return;
    }
    for (const Triangle& triangle : triangles)
      logs_[lane].append(static_cast<std::size_t>(triangle.corners[0] >> part_bits_), triangle);
  }

  // Calls use(triangles) for all of them in order, some at a time, and poll() where that takes long.
  template <class Use>
  void for_each(const Use& use, const std::function<void()>& poll) {
    const auto use_sorted = [&](TriangleSort& sort) {
      const auto read = [&](std::vector<Triangle>& some) { return sort.read(some, kTrianglesAtOnce); };
      read_ahead<std::vector<Triangle>>(sorting_.background, read,
                                        [&](const std::vector<Triangle>& some) { use(std::span(some)); });
    };
    if (all_) {
      all_->finish(0, poll);
      use_sorted(*all_);
      return;
    }
    const Reservation charge = reserve_for_sorting();
    // While one part is used, the next is sorted.
    Sorted current, next;
    Worker worker;
    const auto start = [&](std::size_t part) {
      if (sorting_.background)
        worker.start([&, part] { sort(part, next); });
      else
        sort(part, next);
    };
    start(0);
    for (std::size_t part = 0; part < parts_; ++part) {
      worker.wait(poll);
      std::swap(current, next);
      if (part + 1 < parts_) start(part + 1);
      if (current.on_disk) use_sorted(*std::exchange(current.on_disk, nullptr));
      for (std::span<const Triangle> left = current.triangles; !left.empty();) {
        const auto some = left.first(std::min(left.size(), kTrianglesAtOnce));
        use(some);
        left = left.subspan(some.size());
      }
    }
  }

 private:
  static constexpr std::size_t kTrianglesAtOnce = 4096;
  // A triangle is in memory up to three times: as it came, sorted, and sorted in the part before. A surface has two for
  // each vertex.
  static constexpr std::size_t kTriangleBytes = 3 * sizeof(Triangle), kUsualTriangles = 2;

  struct LowestLess : std::less<Triangle> {
    static std::uint64_t rank(const Triangle& triangle) {
      if constexpr (sizeof(Rank) == 8) return triangle.corners[0];
      return std::uint64_t{triangle.corners[0]} << 32 | triangle.corners[1];
    }
  };
  using TriangleSort = ExternalSort<Triangle, PlainCodec<Triangle>, LowestLess>;
  using Logs = PartitionLogs<Triangle>;

  struct Sorted {
    std::vector<Triangle> triangles;
    std::unique_ptr<TriangleSort> on_disk;  // instead, for a large part
  };

  std::size_t part_entries() const { return std::size_t{1} << part_bits_; }

  std::uint64_t count(std::size_t part) const {
    std::uint64_t sum = 0;
    for (const Logs& logs : logs_) sum += logs.count(part);
    return sum;
  }
  bool fits(std::uint64_t count) const { return count * kTriangleBytes <= sorting_.allowance_bytes; }

  Reservation reserve_for_sorting() const {
    std::uint64_t most = 0;
    for (std::size_t part = 0; part < parts_; ++part)
      if (fits(count(part))) most = std::max(most, count(part));
    return budget_.reserve("reorder", most * kTriangleBytes + part_entries() * sizeof(std::uint32_t));
  }

  void sort(std::size_t part, Sorted& to) {
    to.triangles.clear();
    const std::uint64_t triangles = count(part);
    if (!fits(triangles)) {
      SortOptions alone = sorting_;
      alone.threads = 1;
      alone.background = false;
      to.on_disk = std::make_unique<TriangleSort>("reorder", temp_, budget_, alone);
      for_each_block(part, [&](std::span<const Triangle> some) { to.on_disk->add(some); });
      to.on_disk->finish();
      return;
    }
    came_.clear();
    came_.reserve(static_cast<std::size_t>(triangles));
    ends_.assign(part_entries(), 0);
    for_each_block(part, [&](std::span<const Triangle> some) {
      came_.insert(came_.end(), some.begin(), some.end());
      for (const Triangle& triangle : some) ++ends_[place_of(triangle)];
    });
    std::uint32_t sum = 0;
    for (std::uint32_t& end : ends_) sum += std::exchange(end, sum);
    to.triangles.resize(came_.size());
    for (const Triangle& triangle : came_) to.triangles[ends_[place_of(triangle)]++] = triangle;
    std::uint32_t begin = 0;
    for (const std::uint32_t end : ends_) {
      sort_rest(std::span(to.triangles).subspan(begin, end - begin));
      begin = end;
    }
  }

  template <class Visit>
  void for_each_block(std::size_t part, const Visit& visit) {
    for (Logs& logs : logs_)
      for (auto some = logs.next_block(part); !some.empty(); some = logs.next_block(part)) visit(some);
  }

  std::size_t place_of(const Triangle& triangle) const {
    return static_cast<std::size_t>(triangle.corners[0]) & (part_entries() - 1);
  }

  // Sorts triangles with the same lowest corner: a few, except in odd meshes.
  static void sort_rest(std::span<Triangle> triangles) {
    constexpr std::size_t kFew = 16;
    if (triangles.size() > kFew) {
      std::sort(triangles.begin(), triangles.end());
      return;
    }
    for (std::size_t i = 1; i < triangles.size(); ++i) {
      const Triangle moving = triangles[i];
      std::size_t to = i;
      for (; to > 0 && rest_less(moving, triangles[to - 1]); --to) triangles[to] = triangles[to - 1];
      triangles[to] = moving;
    }
  }
  static bool rest_less(const Triangle& a, const Triangle& b) {
    if constexpr (sizeof(Rank) == 4) {
      const auto rest = [](const Triangle& t) { return std::uint64_t{t.corners[1]} << 32 | t.corners[2]; };
      return rest(a) < rest(b);
    }
    return a < b;
  }

  const io::TempDir& temp_;
  MemoryBudget& budget_;
  SortOptions sorting_;
  unsigned part_bits_ = 0;  // a part is for 2^this vertices
  std::size_t parts_ = 0;
  std::vector<Logs> logs_;  // by lane
  std::mutex mutex_;        // of the next
  std::optional<TriangleSort> all_;
  // Scratch memory of sort().
  std::vector<Triangle> came_;
  std::vector<std::uint32_t> ends_;
};

}  // namespace reeb::ooc
