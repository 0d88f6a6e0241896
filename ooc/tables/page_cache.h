// Pages of 4 KiB, some in memory and the rest in an unnamed file: the storage of a PagedTable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {

// Page k is kPageBytes bytes, at first repetitions of a fill pattern. Pages stay in memory while the allowance and the
// budget permit. After that, the clock algorithm (second chance) picks a page that was not touched recently, and writes
// it if it was changed. While all pages fit, nothing is written and no file is made. A page that consists of
// repetitions of a second pattern when its turn comes is not written either; the directory says what it is.
//
// Pages are small, since most of what is needed again is a line of vertices here and there: the border of each patch,
// the last row. Pages that follow each other are written in one call, so small ones cost little more time than large
// ones.
//
// MEMORY: each resident page, and 4 bytes for each page ever named, are reserved from the budget.
// THREADS: one at a time.
class PageCache {
 public:
  static constexpr std::size_t kPageBytes = 4 << 10;
  // The budget must grant at least this many frames; with fewer, nearly every access would be a miss.
  static constexpr std::size_t kRequiredFrames = 64;

  // `owner` is a string literal for the budget's texts. `temp` must outlive this. `usual` is the second pattern; empty:
  // none.
  PageCache(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes,
            std::span<const std::byte> fill, std::span<const std::byte> usual = {});
  PageCache(PageCache&&) noexcept = default;
  PageCache& operator=(PageCache&&) noexcept = default;

  // The bytes of page `page`, in memory until the next call that names another page. The page is marked as changed if
  // `writing`.
  std::byte* page(std::size_t page, bool writing) {
    const std::uint32_t place = page < places_.size() ? places_[page] : kFresh;
    if (place < kUsual) [[likely]] {
      Frame& frame = frames_[place];
      frame.marks |= writing ? kTouched | kDirty : kTouched;
      return frame.bytes;
    }
    return fault(page, writing);
  }

  // True only if the page was never changed; false for every page that is in memory.
  bool is_fresh(std::size_t page) const { return page >= places_.size() || places_[page] == kFresh; }

  // True only if the page is repetitions of the second pattern; false for every page that is in memory.
  bool is_usual(std::size_t page) const { return page < places_.size() && places_[page] == kUsual; }

  // Changes the fill pattern. REQUIRES: no page was named yet.
  void set_fill(std::span<const std::byte> fill);

  // Forgets the pages from this one on: they are as if never named. Their memory goes to other pages.
  void drop_from(std::size_t page);

  // Raises the allowance to this, if it is less.
  void allow(std::uint64_t bytes) { allowance_ = std::max(allowance_, bytes); }

  std::uint64_t resident_bytes() const { return frames_.size() * kPageBytes; }
  // How often a page was read again.
  std::uint64_t refetches() const { return refetches_; }
  // Bytes written to the file so far.
  std::uint64_t spilled_bytes() const { return spilled_; }
  // Whether access is too scattered for the memory. Fetching a page again costs about 30 us; a coherent mesh needs each
  // page again a few times at most.
  bool is_thrashing() const { return refetches_ > 64 + 8 * places_.size(); }

 private:
  // Where a page is: in the frame with this number, or one of these values.
  static constexpr std::uint32_t kFresh = ~std::uint32_t{0}, kOnDisk = kFresh - 1, kUsual = kFresh - 2;
  static constexpr std::uint32_t kTouched = 1, kDirty = 2, kStored = 4;  // kStored: in the file, too
  static constexpr std::size_t kNoPage = ~std::size_t{0};
  struct Frame {
    std::byte* bytes;
    std::size_t page;
    std::uint32_t marks;
  };
  static constexpr std::size_t kBlockFrames = 16;  // frames whose memory is allocated at once

  std::byte* fault(std::size_t page, bool writing);
  void grow_directory(std::size_t pages);
  std::uint32_t take_frame();
  bool may_grow();
  std::uint32_t evict_one();
  void write_from(std::size_t first);
  bool consists_of_usual(const std::byte* bytes) const;

  const char* owner_;
  const io::TempDir* temp_;
  std::uint64_t allowance_;
  std::vector<std::byte> fill_, usual_;
  Reservation pages_charge_, directory_charge_;
  std::vector<std::uint32_t> places_;                 // by page
  std::vector<Frame> frames_;                         // in the order of the clock
  std::vector<std::uint32_t> free_;                   // frames of pages that were forgotten
  std::vector<std::unique_ptr<std::byte[]>> blocks_;  // memory of the frames
  std::size_t hand_ = 0;                              // into frames_
  io::File file_;
  std::uint64_t spilled_ = 0, refetches_ = 0;
};

}  // namespace reeb::ooc
