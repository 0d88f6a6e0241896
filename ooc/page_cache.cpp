#include "ooc/page_cache.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace reeb::ooc {

PageCache::PageCache(const char* owner, const TempDir& temp, MemoryBudget& budget,
                     std::uint64_t allowance_bytes, std::span<const std::byte> fill)
    : owner_(owner),
      temp_(&temp),
      allowance_(std::max<std::uint64_t>(allowance_bytes, kLeastFrames * kPageBytes)),
      fill_(fill.begin(), fill.end()),
      pages_charge_(budget.reserve(owner, 0)),
      directory_charge_(budget.reserve(owner, 0)) {}

std::byte* PageCache::fault(std::size_t page, bool writing) {
  if (page >= pages_.size()) grow_directory(page + 1);
  Frame frame = take_frame(page);
  std::uint32_t& marks = pages_[page].marks;
  if ((marks & kOnDisk) != 0) {
    file_.read_at(page * kPageBytes, {frame.get(), kPageBytes});
    ++refetches_;
  } else {
    fill_fresh(frame.get());
  }
  marks = (marks & kOnDisk) | kTouched | (writing ? kDirty : 0);
  pages_[page].frame = std::move(frame);
  return pages_[page].frame.get();
}

void PageCache::grow_directory(std::size_t pages) {
  if (pages > pages_.capacity()) {
    const std::size_t capacity = std::max({pages, pages_.capacity() * 2, std::size_t{64}});
    directory_charge_.resize(capacity * sizeof(Page));
    pages_.reserve(capacity);
  }
  pages_.resize(pages);
}

// A frame for `page`, which takes its place on the clock: new memory if it may grow, else another
// page's.
PageCache::Frame PageCache::take_frame(std::size_t page) {
  const std::uint64_t grown = resident_bytes() + kPageBytes;
  const bool must_grow = resident_.size() < kLeastFrames;
  if (must_grow) pages_charge_.resize(grown);
  if (must_grow || (grown <= allowance_ && pages_charge_.try_resize(grown))) {
    resident_.push_back(page);
    return std::make_unique_for_overwrite<std::byte[]>(kPageBytes);
  }
  return evict_one(page);
}

PageCache::Frame PageCache::evict_one(std::size_t successor) {
  while ((pages_[resident_[hand_]].marks & kTouched) != 0) {
    pages_[resident_[hand_]].marks &= ~kTouched;
    hand_ = (hand_ + 1) % resident_.size();
  }
  const std::size_t victim = resident_[hand_];
  Page& old = pages_[victim];
  if ((old.marks & kDirty) != 0) {
    if (!file_.is_open()) file_ = temp_->create_unnamed(owner_);
    file_.write_at(victim * kPageBytes, {old.frame.get(), kPageBytes});
    spilled_ += kPageBytes;
    old.marks = kOnDisk;
  }
  resident_[hand_] = successor;
  hand_ = (hand_ + 1) % resident_.size();
  return std::move(old.frame);
}

void PageCache::fill_fresh(std::byte* bytes) const {
  std::size_t filled = std::min(fill_.size(), kPageBytes);
  std::memcpy(bytes, fill_.data(), filled);
  while (filled < kPageBytes) {  // doubling keeps the pattern in step
    const std::size_t more = std::min(filled, kPageBytes - filled);
    std::memcpy(bytes + filled, bytes, more);
    filled += more;
  }
}

}  // namespace reeb::ooc
