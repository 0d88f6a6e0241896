#include "ooc/tables/page_cache.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace reeb::ooc {
namespace {

void fill_page(std::byte* bytes, std::span<const std::byte> pattern) {
  std::size_t filled = std::min(pattern.size(), PageCache::kPageBytes);
  std::memcpy(bytes, pattern.data(), filled);
  while (filled < PageCache::kPageBytes) {  // doubling keeps the pattern in step
    const std::size_t more = std::min(filled, PageCache::kPageBytes - filled);
    std::memcpy(bytes + filled, bytes, more);
    filled += more;
  }
}

}  // namespace

PageCache::PageCache(const char* owner, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes,
                     std::span<const std::byte> fill, std::span<const std::byte> usual)
    : owner_(owner),
      temp_(&temp),
      allowance_(std::max<std::uint64_t>(allowance_bytes, kRequiredFrames * kPageBytes)),
      fill_(fill.begin(), fill.end()),
      usual_(usual.begin(), usual.end()),
      pages_charge_(budget.reserve(owner, 0)),
      directory_charge_(budget.reserve(owner, 0)) {}

std::byte* PageCache::fault(std::size_t page, bool writing) {
  if (page >= places_.size()) grow_directory(page + 1);
  const std::uint32_t number = take_frame();
  Frame& frame = frames_[number];
  const bool stored = places_[page] == kOnDisk, usual = places_[page] == kUsual;
  if (stored) {
    file_.read_at(page * kPageBytes, {frame.bytes, kPageBytes});
    ++refetches_;
  } else {
    fill_page(frame.bytes, usual ? usual_ : fill_);
  }
  frame.page = page;
  // A page of the second pattern is nowhere else, so it counts as changed.
  frame.marks = kTouched | (stored ? kStored : 0) | (writing || usual ? kDirty : 0);
  places_[page] = number;
  return frame.bytes;
}

void PageCache::set_fill(std::span<const std::byte> fill) {
  if (!places_.empty()) throw std::logic_error("PageCache: a new fill pattern after the first page");
  fill_.assign(fill.begin(), fill.end());
}

void PageCache::drop_from(std::size_t page) {
  for (std::size_t at = page; at < places_.size(); ++at) {
    const std::uint32_t place = places_[at];
    if (place >= kUsual) continue;
    frames_[place].page = kNoPage;
    frames_[place].marks = 0;
    free_.push_back(place);
  }
  if (page < places_.size()) places_.resize(page);
}

void PageCache::grow_directory(std::size_t pages) {
  if (pages > places_.capacity()) {
    const std::size_t capacity = std::max({pages, places_.capacity() + places_.capacity() / 4, std::size_t{1024}});
    directory_charge_.resize(capacity * sizeof(std::uint32_t));
    places_.reserve(capacity);
  }
  places_.resize(pages, kFresh);
}

// A frame without a page: in new memory if the cache may grow, else taken from another page.
std::uint32_t PageCache::take_frame() {
  if (!free_.empty()) {
    const std::uint32_t frame = free_.back();
    free_.pop_back();
    return frame;
  }
  const auto next = static_cast<std::uint32_t>(frames_.size());
  if (frames_.size() == blocks_.size() * kBlockFrames) {
    if (!may_grow()) return evict_one();
    blocks_.push_back(std::make_unique_for_overwrite<std::byte[]>(kBlockFrames * kPageBytes));
  }
  frames_.push_back({blocks_.back().get() + next % kBlockFrames * kPageBytes, kNoPage, 0});
  return next;
}

// Whether the cache may grow by a block of frames. THROWS: Error{kResource} if the budget does not grant the required
// frames.
bool PageCache::may_grow() {
  const std::uint64_t grown = (blocks_.size() + 1) * kBlockFrames * kPageBytes;
  if (grown <= kRequiredFrames * kPageBytes) {
    pages_charge_.resize(grown);
    return true;
  }
  return grown <= allowance_ && pages_charge_.try_resize(grown);
}

std::uint32_t PageCache::evict_one() {
  while ((frames_[hand_].marks & kTouched) != 0) {
    frames_[hand_].marks &= ~kTouched;
    hand_ = (hand_ + 1) % frames_.size();
  }
  const auto victim = static_cast<std::uint32_t>(hand_);
  hand_ = (hand_ + 1) % frames_.size();
  Frame& frame = frames_[victim];
  if (frame.page == kNoPage) return victim;  // left so by a read that failed
  if ((frame.marks & kDirty) != 0) {
    if (consists_of_usual(frame.bytes)) {
      places_[frame.page] = kUsual;
      frame.page = kNoPage;
      return victim;
    }
    write_from(victim);
  }
  places_[frame.page] = (frame.marks & kStored) != 0 ? kOnDisk : kFresh;
  frame.page = kNoPage;
  return victim;
}

// Writes the page of a frame, and with it the pages that follow it in memory and in the file, and that would be written
// next.
void PageCache::write_from(std::size_t first) {
  const Frame& frame = frames_[first];
  std::size_t end = first + 1;
  const auto follows = [&](const Frame& next) {
    const std::size_t before = end - first;
    return next.page == frame.page + before && next.bytes == frame.bytes + before * kPageBytes &&
           (next.marks & (kDirty | kTouched)) == kDirty && !consists_of_usual(next.bytes);
  };
  while (end < frames_.size() && follows(frames_[end])) ++end;
  if (!file_.is_open()) file_ = temp_->create_unnamed(owner_);
  const std::size_t bytes = (end - first) * kPageBytes;
  file_.write_at(frame.page * kPageBytes, {frame.bytes, bytes});
  spilled_ += bytes;
  for (std::size_t f = first; f < end; ++f) frames_[f].marks = (frames_[f].marks & ~kDirty) | kStored;
}

// Each pattern after the first is compared with the one before it.
bool PageCache::consists_of_usual(const std::byte* bytes) const {
  const std::size_t size = usual_.size();
  return size != 0 && std::memcmp(bytes, usual_.data(), size) == 0 &&
         std::memcmp(bytes, bytes + size, kPageBytes - size) == 0;
}

}  // namespace reeb::ooc
