// Packed lists of buckets in a file, for a BasicArcBucketLists: the counterpart of PackedLists.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/ids.h"
#include "ooc/stored_hierarchy/paged_tables.h"

namespace reeb::ooc {

// A list that changes is appended to the file; the former one stays there. Short lists that were read lately are in
// memory, and the last long one, since a step asks for a list several times.
//
// THROWS: Error{kResource} if the disk is full.
// MEMORY: the places of lists, as `tables` say; buffers of about 200 KB, and the longest list.
class StoredLists {
 public:
  StoredLists(const io::TempDir& temp, const PagedTables& tables, std::uint32_t arcs);

  std::size_t size() const { return places_.end_id().value(); }
  // Empty for an arc without buckets. Valid until the next call.
  std::span<const std::byte> of(std::size_t arc) const;
  void replace(std::size_t arc, std::span<const std::byte> packed);

  // Nothing is collected: disk is not scarce, as memory is.
  void collect() {}
  void prefetch_place(std::size_t /*arc*/) const {}
  void prefetch(std::size_t /*arc*/) const {}

  std::uint64_t spilled_bytes() const { return written_; }

 private:
  static constexpr std::size_t kBufferBytes = 64 << 10, kSlots = 512, kSlotBytes = 256;
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};
  struct Place {
    std::uint64_t begin = 0, bytes = 0;
  };
  struct Slot {
    std::uint64_t begin = kNowhere;
    std::array<std::byte, kSlotBytes> bytes;
  };

  const io::TempDir* temp_;
  PagedIdTable<ArcId, Place> places_;
  io::File file_;
  std::uint64_t written_ = 0;      // bytes of the file
  std::vector<std::byte> buffer_;  // what follows them
  mutable std::vector<Slot> slots_;
  mutable std::vector<std::byte> long_list_;
  mutable std::uint64_t long_begin_ = kNowhere;
};

}  // namespace reeb::ooc
