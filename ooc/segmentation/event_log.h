// The history of arcs on disk: written once, and read backwards.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/segmentation/arc_history.h"
#include "ooc/segmentation/placed_vertices.h"

namespace reeb::ooc {

// 2 to 22 bytes for each event, in blocks of 64 KiB. Nothing is written to disk before the first block is full.
//
// THROWS: Error{kResource} of the budget or the disk.
class EventLog : public ArcLog {
 public:
  // Vertices on arcs that were settled before their events could be written go to `placed`; null: there are none.
  EventLog(const io::TempDir& temp, MemoryBudget& budget, PlacedVertices* placed = nullptr);

  void add(Arc arc) override { write(ArcEvent::Kind::kAdd, kDown, arc); }
  void place(Arc arc, const SweepKey& vertex) override { write(ArcEvent::Kind::kPlace, kDown, arc, vertex); }
  void merge(Arc gone, Arc kept) override { write(ArcEvent::Kind::kMerge, kDown, gone, kept); }
  void cut(Arc from, Arc into, const SweepKey& at, Direction side) override {
    write(ArcEvent::Kind::kCut, side, from, into, at);
  }
  void join(Arc gone, Arc kept, const SweepKey& at, Direction side) override {
    write(ArcEvent::Kind::kJoin, side, gone, kept, at);
  }
  void lay(Arc gone, Arc onto, const SweepKey& at, Direction side) override {
    write(ArcEvent::Kind::kLay, side, gone, onto, at);
  }
  void drop(Arc arc) override { write(ArcEvent::Kind::kDrop, kDown, arc); }
  void settle(Arc arc) override { write(ArcEvent::Kind::kSettle, kDown, arc, settle_unnamed(1)); }
  std::uint32_t settle_unnamed(std::uint32_t count) override;
  void place_on_settled(std::uint32_t number, const SweepKey& vertex) override { placed_->add_on_arc(vertex, number); }

  std::uint32_t settled() const { return settled_; }
  // Calls visit(event) for all events, from the last to the first. REQUIRES: nothing is added afterwards.
  template <class Visit>
  void read_backwards(const Visit& visit) {
    do {
      while (filled_ != 0) visit(take_last());
    } while (fetch_block_before());
  }

 private:
  static constexpr std::size_t kBlockBytes = 64 << 10, kMaxEventBytes = 32;

  // The parts of an event are followed by a byte with its kind and side, from which the length follows.
  template <class... Parts>
  void write(ArcEvent::Kind kind, Direction side, const Parts&... parts) {
    if (filled_ + kMaxEventBytes > kBlockBytes) write_block();
    (put(parts), ...);
    block_[filled_++] = static_cast<std::byte>(static_cast<unsigned>(kind) << 1 | (side == kUp ? 1u : 0u));
  }
  template <class Part>
  void put(const Part& part) {
    std::memcpy(&block_[filled_], &part, sizeof part);
    filled_ += sizeof part;
  }
  template <class Part>
  void take(Part& part) {
    filled_ -= sizeof part;
    std::memcpy(&part, &block_[filled_], sizeof part);
  }
  ArcEvent take_last();
  void write_block();
  bool fetch_block_before();

  Reservation charge_;
  io::File file_;
  PlacedVertices* placed_;
  std::vector<std::byte> block_;
  std::size_t filled_ = 0;
  std::uint64_t written_ = 0;  // each block, and then its length
  std::uint32_t settled_ = 0;
};

}  // namespace reeb::ooc
