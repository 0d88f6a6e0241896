// Pages of 64 KiB, some in memory and the rest in an unnamed file: what a PagedTable stands on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "ooc/file.h"
#include "ooc/temp_dir.h"

namespace reeb::ooc {

// Page k is a run of kPageBytes bytes that starts as repetitions of a fill pattern. Pages stay in
// memory while the allowance and the budget permit; then the clock (second chance) picks one that
// was not touched lately, and writes it if it was changed. Nothing is written, and no file made,
// while all pages fit.
//
// MEMORY: each resident page and the page directory are charged to the budget.
// THREADS: one at a time.
class PageCache {
 public:
  static constexpr std::size_t kPageBytes = 64 << 10;
  // Fewer frames than this make no progress worth having; the budget must grant them.
  static constexpr std::size_t kLeastFrames = 4;

  // `owner` is a string literal for the budget's texts. `temp` must outlive this.
  PageCache(const char* owner, const TempDir& temp, MemoryBudget& budget,
            std::uint64_t allowance_bytes, std::span<const std::byte> fill);
  PageCache(PageCache&&) noexcept = default;
  PageCache& operator=(PageCache&&) noexcept = default;

  // The bytes of page `page`, in memory until the next call that names another page; the page is
  // marked as changed if `writing`.
  std::byte* page(std::size_t page, bool writing) {
    if (page < pages_.size() && pages_[page].frame != nullptr) [[likely]] {
      pages_[page].marks |= writing ? kTouched | kDirty : kTouched;
      return pages_[page].frame.get();
    }
    return fault(page, writing);
  }

  std::uint64_t resident_bytes() const { return resident_.size() * kPageBytes; }
  // Bytes written to the file so far.
  std::uint64_t spilled_bytes() const { return spilled_; }
  // Pages read back so far, and pages ever named: where the first far exceeds the second, the
  // access is too scattered for the memory at hand.
  std::uint64_t refetches() const { return refetches_; }
  std::uint64_t page_count() const { return pages_.size(); }

 private:
  using Frame = std::unique_ptr<std::byte[]>;
  static constexpr std::uint32_t kTouched = 1, kDirty = 2, kOnDisk = 4;
  struct Page {
    Frame frame;  // null when not in memory
    std::uint32_t marks = 0;
  };

  std::byte* fault(std::size_t page, bool writing);
  void grow_directory(std::size_t pages);
  Frame take_frame(std::size_t page);
  Frame evict_one(std::size_t successor);
  void fill_fresh(std::byte* bytes) const;

  const char* owner_;
  const TempDir* temp_;
  std::uint64_t allowance_;
  std::vector<std::byte> fill_;
  Reservation pages_charge_, directory_charge_;
  std::vector<Page> pages_;
  std::vector<std::size_t> resident_;  // the clock's face: pages in memory
  std::size_t hand_ = 0;               // into resident_
  File file_;
  std::uint64_t spilled_ = 0, refetches_ = 0;
};

}  // namespace reeb::ooc
