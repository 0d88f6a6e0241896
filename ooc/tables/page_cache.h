// Pages of 4 KiB, some in memory and the rest in an unnamed file: what a PagedTable stands on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {

// Page k is a run of kPageBytes bytes that starts as repetitions of a fill pattern. Pages stay in
// memory while the allowance and the budget permit; then the clock (second chance) picks one that
// was not touched lately, and writes it if it was changed. Nothing is written, and no file made,
// while all pages fit.
//
// Pages are small, since what is needed again is mostly a line of vertices here and there: the border
// of each patch, the last row. The system collects what is written, so that small pages cost little
// more of its time than large ones.
//
// MEMORY: each resident page, and 4 bytes for each page ever named, are charged to the budget.
// THREADS: one at a time.
class PageCache {
 public:
  static constexpr std::size_t kPageBytes = 4 << 10;
  // Fewer frames than this make no progress worth having; the budget must grant them.
  static constexpr std::size_t kLeastFrames = 64;

  // `owner` is a string literal for the budget's texts. `temp` must outlive this.
  PageCache(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes,
            std::span<const std::byte> fill);
  PageCache(PageCache&&) noexcept = default;
  PageCache& operator=(PageCache&&) noexcept = default;

  // The bytes of page `page`, in memory until the next call that names another page; the page is
  // marked as changed if `writing`.
  std::byte* page(std::size_t page, bool writing) {
    const std::uint32_t place = page < places_.size() ? places_[page] : kFresh;
    if (place < kOnDisk) [[likely]] {
      Frame& frame = frames_[place];
      frame.marks |= writing ? kTouched | kDirty : kTouched;
      return frame.bytes;
    }
    return fault(page, writing);
  }

  std::uint64_t resident_bytes() const { return frames_.size() * kPageBytes; }
  // Bytes written to the file so far.
  std::uint64_t spilled_bytes() const { return spilled_; }
  // Whether access is too scattered for the memory. A refetch costs some 30 us; a coherent mesh needs each page
  // again a few times at most.
  bool is_thrashing() const { return refetches_ > 64 + 8 * places_.size(); }

 private:
  // Where a page is: in the frame of this number, or one of these.
  static constexpr std::uint32_t kFresh = ~std::uint32_t{0}, kOnDisk = kFresh - 1;
  static constexpr std::uint32_t kTouched = 1, kDirty = 2, kStored = 4;  // kStored: in the file, too
  static constexpr std::size_t kNoPage = ~std::size_t{0};
  struct Frame {
    std::byte* bytes;
    std::size_t page;
    std::uint32_t marks;
  };
  static constexpr std::size_t kBlockFrames = 16;  // whose memory is asked for at once

  std::byte* fault(std::size_t page, bool writing);
  void grow_directory(std::size_t pages);
  std::uint32_t take_frame();
  bool may_grow();
  std::uint32_t evict_one();
  void fill_fresh(std::byte* bytes) const;

  const char* owner_;
  const io::TempDir* temp_;
  std::uint64_t allowance_;
  std::vector<std::byte> fill_;
  Reservation pages_charge_, directory_charge_;
  std::vector<std::uint32_t> places_;                 // by page
  std::vector<Frame> frames_;                         // the clock's face
  std::vector<std::unique_ptr<std::byte[]>> blocks_;  // memory of the frames
  std::size_t hand_ = 0;                              // into frames_
  io::File file_;
  std::uint64_t spilled_ = 0, refetches_ = 0;
};

}  // namespace reeb::ooc
