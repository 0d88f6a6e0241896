#include "ooc/whole_mesh/reorder.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ooc/sorting/external_sort.h"
#include "ooc/tables/partition_logs.h"
#include "ooc/threads/read_ahead.h"
#include "ooc/threads/worker.h"
#include "ooc/whole_mesh/ranked_triangles.h"
#include "ooc/whole_mesh/vertex_curve.h"
#include "ooc/whole_mesh/vertex_slices.h"

namespace reeb::ooc {

namespace {

constexpr std::size_t kItemsAtOnce = 4096;  // vertices or triangles
constexpr std::size_t kCarried = 3;         // columns, at most

// Ends the thread of the vertices when the other thread has failed.
struct Stopped {};
struct StopAtEnd {
  std::atomic<bool>& stops;
  ~StopAtEnd() { stops = true; }
};

// Called with the corners of some triangles at a time, in their new order. The sort has reserved its memory by then.
using UseTriangles = std::function<void(std::span<const VertexId>)>;

// Ranks have 32 bits where that suffices: what is written to disk is most of the time.
template <class Rank>
class Reorder {
 public:
  Reorder(IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget, const ReorderOptions& options,
          const UseTriangles& use)
      : mesh_(mesh),
        temp_(temp),
        budget_(budget),
        options_(options),
        use_(use),
        vertex_count_(mesh.vertex_count()),
        slices_(vertex_count_, options.allowance_bytes / 4 / sizeof(Rank)),
        block_bytes_(has_room_for(Logs::kLargeBlockBytes) ? Logs::kLargeBlockBytes : Logs::kBlockBytes),
        has_two_threads_(options.threads > 1 && has_room_for(Logs::kBlockBytes)),
        ranks_(temp.create_unnamed("ranks")),
        result_(std::make_unique<ReorderedMesh>(mesh, temp, budget, options.allowance_bytes / 4)) {}

  std::unique_ptr<ReorderedMesh> run() {
    if (has_two_threads_) {
      run_in_two_threads();
    } else {
      rank_vertices();
      place_columns();
      read_places(kPlaced, kLooked);
      Triangles triangles(temp_, budget_, vertex_count_, lanes_.size(), sorting());
      look_up(0, triangles, Thread::kOwner);
      append_sorted(triangles);
    }
    result_->set_simplex_counts(mesh_.simplex_counts());
    return std::move(result_);
  }

 private:
  using Logs = PartitionLogs<Rank>;
  using Triangles = RankedTriangles<Rank>;
  using Triangle = RankedTriangle<Rank>;
  // The corners of every other batch of triangles, or of all.
  struct Lane {
    Logs ranks;                                          // by slice; first, their places in it
    PartitionLogs<std::array<std::uint16_t, 3>> slices;  // of each triangle
  };
  enum class Thread { kOwner, kWorker };

  // The double is in two parts, so that it needs no space before it.
  struct PlacedNumber {
    Rank place;  // in its slice
    std::array<std::uint32_t, 2> number;
  };
  struct PlacedRank {
    Rank place, rank;
  };
  // With the first columns, which then need no partitioning. Most columns have values that are float32.
  struct KeyedVertex {
    std::uint64_t key;
    Rank vertex;
    std::array<float, kCarried> values;
    friend bool operator<(const KeyedVertex& a, const KeyedVertex& b) {
      return a.key < b.key || (a.key == b.key && a.vertex < b.vertex);
    }
  };
  struct KeyLess : std::less<KeyedVertex> {
    static std::uint64_t rank(const KeyedVertex& keyed) { return keyed.key; }
  };
  using KeySort = ExternalSort<KeyedVertex, PlainCodec<KeyedVertex>, KeyLess>;

  // One thread looks up vertices, another reads triangles. Then both look up corners.
  void run_in_two_threads() {
    std::optional<Triangles> triangles;
    Worker vertices;
    const StopAtEnd stop{stops_};  // before the worker ends
    vertices.start([this] { rank_vertices(); });
    read_places(0, kPlaced);
    vertices.wait([this] { poll(); });
    triangles.emplace(temp_, budget_, vertex_count_, lanes_.size(), sorting());
    vertices.start([&] {
      place_columns();
      look_up_some(*triangles, Thread::kWorker);
    });
    look_up_some(*triangles, Thread::kOwner);
    vertices.wait([this] { poll(); });
    append_sorted(*triangles);
  }

  // The parts of the time after which a step is done, about.
  static constexpr double kKeyed = 0.05, kRanked = 0.15, kPlaced = 0.25, kLooked = 0.5, kSorted = 0.75;

  void tell(double done) const {
    done_ = std::max(done_, done);
    poll();
  }
  // Where little is done at a time.
  void poll() const {
    if (options_.progress) options_.progress(done_);
  }
  // For the steps that look up vertices. In a thread of their own they tell nothing.
  void tell_vertices(double done) const {
    if (!has_two_threads_) done_ = done;
    poll_vertices();
  }
  void poll_vertices() const {
    if (!has_two_threads_) return poll();
    if (stops_) throw Stopped();
  }
  // For the steps that both threads do.
  void tell(Thread thread, double done) const {
    if (thread == Thread::kOwner) return tell(done);
    if (stops_) throw Stopped();
  }
  // For a step that reads the mesh, and lasts from `from` to `to`.
  void tell_reading(double from, double to) const {
    tell(from + (to - from) * static_cast<double>(mesh_.bytes_read()) /
                    static_cast<double>(std::max<std::uint64_t>(mesh_.bytes_total(), 1)));
  }

  // Calls visit(first, count, values) for ranges of consecutive vertices; values as from gather().
  template <class Visit>
  void for_each_range(std::span<const unsigned> columns, const Visit& visit) {
    std::vector<VertexId> ids;
    std::vector<double> values;
    for (std::uint64_t first = 0; first < vertex_count_; first += ids.size()) {
      ids.clear();
      for (std::uint64_t v = first; v < std::min(first + kItemsAtOnce, vertex_count_); ++v) ids.emplace_back(v);
      values.resize(columns.size() * ids.size());
      poll_vertices();
      mesh_.gather(ids, columns, values);
      visit(first, ids.size(), std::span<const double>(values));
    }
  }

  // The rank of a vertex is its place along the curve.
  void rank_vertices() {
    KeySort by_key("reorder", temp_, budget_, sorting());
    add_keys(by_key);
    by_key.finish(0, [this] { poll_vertices(); });
    tell_vertices(kKeyed);
    PartitionLogs<PlacedRank> by_slice("reorder", temp_, budget_, slices_.count(), block_bytes_);
    std::uint64_t rank = 0;
    std::vector<VertexId> ids;
    std::vector<std::uint64_t> originals;
    std::vector<double> values;
    const auto read = [&](std::vector<KeyedVertex>& some) { return by_key.read(some, kItemsAtOnce); };
    read_ahead<std::vector<KeyedVertex>>(has_two_threads_, read, [&](const std::vector<KeyedVertex>& some) {
      poll_vertices();
      originals.clear();
      ids.clear();
      for (const KeyedVertex& keyed : some) ids.emplace_back(keyed.vertex);
      mesh_.to_original(ids);
      for (const VertexId id : ids) originals.push_back(id.value());
      result_->set_originals(rank, originals);
      for (unsigned column = 0; column < kCarried; ++column) {
        if (!is_carried(column)) continue;
        values.clear();
        for (const KeyedVertex& keyed : some) values.push_back(double{keyed.values[column]});
        result_->append_column(column, values);
      }
      for (const KeyedVertex& keyed : some)
        by_slice.append(slices_.slice_of(keyed.vertex), {place_of(keyed.vertex), static_cast<Rank>(rank++)});
    });
    tell_vertices(kRanked);
    const Reservation charge = budget_.reserve("reorder", slices_.entries() * sizeof(Rank));
    std::vector<Rank> slice;
    for (std::size_t s = 0; s < slices_.count(); ++s) {
      poll_vertices();
      slice.resize(slices_.size(s));
      for (auto some = by_slice.next_block(s); !some.empty(); some = by_slice.next_block(s))
        for (const PlacedRank& placed : some) slice[placed.place] = placed.rank;
      ranks_.write_at(s * slices_.entries() * sizeof(Rank), std::as_bytes(std::span(slice)));
    }
  }

  void add_keys(KeySort& by_key) {
    const VertexCurve curve(box(), options_.in_slabs ? VertexCurve::slab_count(vertex_count_) : 1);
    std::vector<unsigned> columns(std::min<std::size_t>(mesh_.column_count(), kCarried));
    std::iota(columns.begin(), columns.end(), 0u);
    std::vector<KeyedVertex> keyed;
    std::vector<std::uint64_t> places;
    for_each_range(columns, [&](std::uint64_t first, std::size_t count, std::span<const double> values) {
      keyed.assign(count, {});
      for (std::size_t k = 0; k < columns.size(); ++k)
        if (!carry(values.subspan(k * count, count), k, keyed)) is_wide_[k] = true;
      places.resize(count);
      curve.places(values, places);
      for (std::size_t i = 0; i < count; ++i) {
        keyed[i].key = places[i];
        keyed[i].vertex = static_cast<Rank>(first + i);
      }
      by_key.add(keyed);
    });
  }

  CurveBox box() {
    std::vector<unsigned> axes(std::min({options_.coordinates, mesh_.column_count(), 3u}));
    std::iota(axes.begin(), axes.end(), 0u);
    CurveBox box(axes.size());
    for_each_range(axes, [&](std::uint64_t, std::size_t count, std::span<const double> values) {
      for (std::size_t a = 0; a < axes.size(); ++a) box.add(a, values.subspan(a * count, count));
    });
    return box;
  }

  // Notes the values of a column. False if one of them is not a float32.
  static bool carry(std::span<const double> values, std::size_t column, std::span<KeyedVertex> keyed) {
    constexpr double kMost = std::numeric_limits<float>::max();
    bool fits = true;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto value = static_cast<float>(std::clamp(values[i], -kMost, kMost));
      keyed[i].values[column] = value;
      fits &= double{value} == values[i];
    }
    return fits;
  }

  // Whether a column came with the keys.
  bool is_carried(unsigned column) const {
    return column < std::min<std::size_t>(mesh_.column_count(), kCarried) && !is_wide_[column];
  }

  void place_columns() {
    for (unsigned column = 0; column < mesh_.column_count(); ++column) {
      if (!is_carried(column)) place_column(column);
      tell_vertices(kRanked + (kPlaced - kRanked) * (column + 1) / mesh_.column_count());
    }
  }

  // Reorders a column from the order of ids to that of ranks.
  void place_column(unsigned column) {
    PartitionLogs<PlacedNumber> by_slice("reorder", temp_, budget_, slices_.count(), block_bytes_);
    std::vector<Rank> ranks;
    for_each_range(std::array{column}, [&](std::uint64_t first, std::size_t count, std::span<const double> values) {
      ranks.resize(count);
      ranks_.read_at(first * sizeof(Rank), std::as_writable_bytes(std::span(ranks)));
      for (std::size_t i = 0; i < count; ++i)
        by_slice.append(slices_.slice_of(ranks[i]),
                        {place_of(ranks[i]), std::bit_cast<std::array<std::uint32_t, 2>>(values[i])});
    });
    const Reservation charge = budget_.reserve("reorder", slices_.entries() * 8);
    std::vector<double> slice;
    for (std::size_t s = 0; s < slices_.count(); ++s) {
      poll_vertices();
      slice.resize(slices_.size(s));
      for (auto some = by_slice.next_block(s); !some.empty(); some = by_slice.next_block(s))
        for (const PlacedNumber& placed : some) slice[placed.place] = std::bit_cast<double>(placed.number);
      result_->append_column(column, slice);
    }
  }

  // Divides the corners of all triangles by slice. Needs no ranks.
  void read_places(double from, double to) {
    for (int lane = 0; lane < (has_two_threads_ ? 2 : 1); ++lane)
      lanes_.push_back(
          {{"reorder", temp_, budget_, slices_.count(), block_bytes_}, {"reorder", temp_, budget_, 1, block_bytes_}});
    std::vector<VertexId> corners;
    mesh_.rewind();
    for (std::size_t batch = 0; mesh_.read(corners, kItemsAtOnce); ++batch) {
      tell_reading(from, to);
      Lane& lane = lanes_[batch % lanes_.size()];
      const auto place = [&](VertexId corner) {
        const std::size_t slice = slices_.slice_of(corner.value());
        lane.ranks.append(slice, place_of(corner.value()));
        return static_cast<std::uint16_t>(slice);
      };
      for (std::size_t t = 0; t < corners.size(); t += 3)
        lane.slices.append(0, {place(corners[t]), place(corners[t + 1]), place(corners[t + 2])});
      triangle_count_ += corners.size() / 3;
    }
  }

  void look_up_some(Triangles& triangles, Thread thread) {
    for (std::size_t lane; (lane = next_lane_++) < lanes_.size();) look_up(lane, triangles, thread);
  }

  // Adds the triangles of a lane, with ranks for corners.
  void look_up(std::size_t lane, Triangles& triangles, Thread thread) {
    auto [ranks, slices] = std::move(lanes_[lane]);  // gone afterwards
    rank_places(ranks, thread);
    // The rank of each corner is the next one in the log of its slice.
    std::vector<Triangle> found;
    std::uint64_t done = 0;
    for (auto some = slices.next_block(0); !some.empty(); some = slices.next_block(0)) {
      tell(thread, kLooked + (kSorted - kLooked) * static_cast<double>(done) / static_cast<double>(slices.count(0)));
      done += some.size();
      found.clear();
      for (const auto& triangle : some)
        found.push_back(Triangle::of({ranks.next(triangle[0]), ranks.next(triangle[1]), ranks.next(triangle[2])}));
      triangles.add(lane, found);
    }
  }

  // Replaces the places of corners in their slices by ranks.
  void rank_places(Logs& corners, Thread thread) {
    const Reservation charge = budget_.reserve("reorder", slices_.entries() * sizeof(Rank));
    std::vector<Rank> slice;
    for (std::size_t s = 0; s < slices_.count(); ++s) {
      tell(thread, kPlaced + (kLooked - kPlaced) * static_cast<double>(s) / static_cast<double>(slices_.count()));
      slice.resize(slices_.size(s));
      ranks_.read_at(s * slices_.entries() * sizeof(Rank), std::as_writable_bytes(std::span(slice)));
      corners.change(s, [&](std::span<Rank> some) {
        for (Rank& corner : some) corner = slice[corner];
      });
    }
  }

  void append_sorted(Triangles& triangles) {
    std::vector<VertexId> corners;
    std::uint64_t appended = 0;
    triangles.for_each(
        [&](std::span<const Triangle> some) {
          appended += some.size();
          tell(kSorted + (1 - kSorted) * static_cast<double>(appended) / static_cast<double>(triangle_count_));
          corners.clear();
          for (const Triangle& triangle : some)
            for (const Rank corner : triangle.corners) corners.emplace_back(corner);
          result_->append_triangles(corners);
          if (use_) use_(corners);
        },
        [this] { poll(); });
  }

  SortOptions sorting() const {
    return {
        .allowance_bytes = options_.allowance_bytes / 2, .threads = options_.threads, .background = has_two_threads_};
  }
  // Whether two threads can hold three partitions with such blocks, a slice of numbers and one of ranks, beside what is
  // sorted. That is the most that they hold.
  bool has_room_for(std::size_t block_bytes) const {
    return 3 * slices_.count() * block_bytes + slices_.entries() * (8 + sizeof(Rank)) <= options_.allowance_bytes / 4;
  }
  Rank place_of(std::uint64_t id) const { return static_cast<Rank>(slices_.place_of(id)); }

  IndexedMesh& mesh_;
  const io::TempDir& temp_;
  MemoryBudget& budget_;
  const ReorderOptions& options_;
  const UseTriangles& use_;
  mutable double done_ = 0;  // as told last
  std::atomic<bool> stops_ = false;
  std::uint64_t vertex_count_, triangle_count_ = 0;
  VertexSlices slices_;
  std::size_t block_bytes_;  // of partitions by slice
  bool has_two_threads_;
  std::vector<Lane> lanes_;
  std::atomic<std::size_t> next_lane_ = 0;
  std::array<bool, kCarried> is_wide_{};  // by column: not all of its values are float32
  io::File ranks_;                        // by vertex
  std::unique_ptr<ReorderedMesh> result_;
};

std::unique_ptr<ReorderedMesh> reorder_and_use(IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget,
                                               const ReorderOptions& options, const UseTriangles& use) {
  if (mesh.vertex_count() <= std::numeric_limits<std::uint32_t>::max())
    return Reorder<std::uint32_t>(mesh, temp, budget, options, use).run();
  return Reorder<std::uint64_t>(mesh, temp, budget, options, use).run();
}

}  // namespace

std::unique_ptr<ReorderedMesh> reorder(IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget,
                                       const ReorderOptions& options) {
  return reorder_and_use(mesh, temp, budget, options, {});
}

SortedMesh reorder_with_last_uses(IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget,
                                  const ReorderOptions& options, const LastUseOptions& uses) {
  std::optional<LastUseScan> scan;  // begins with the first triangles, after the sort has reserved its memory
  const auto begin = [&] { scan.emplace(mesh.vertex_count(), 0, temp, budget, uses); };
  const auto use = [&](std::span<const VertexId> corners) {
    if (!scan) begin();
    scan->look_at(corners);
    scan->use(corners);
  };
  std::unique_ptr<ReorderedMesh> sorted = reorder_and_use(mesh, temp, budget, options, use);
  if (!scan) begin();
  return {std::move(sorted), scan->finish()};
}

}  // namespace reeb::ooc
