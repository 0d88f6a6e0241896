#include "ooc/stored_hierarchy/stored_lists.h"

#include <utility>

namespace reeb::ooc {

StoredLists::StoredLists(const io::TempDir& temp, const PagedTables& tables, std::uint32_t arcs)
    : temp_(&temp), places_(tables.table<ArcId>(arcs, Place{})), slots_(kSlots) {
  buffer_.reserve(kBufferBytes);
}

std::span<const std::byte> StoredLists::of(std::size_t arc) const {
  const Place place = std::as_const(places_)[ArcId(static_cast<std::uint32_t>(arc))];
  if (place.bytes == 0) return {};
  if (place.begin >= written_)
    return std::span(buffer_).subspan(static_cast<std::size_t>(place.begin - written_), place.bytes);
  if (place.bytes > kSlotBytes) {
    if (long_begin_ == place.begin) return long_list_;
    long_begin_ = kNowhere;
    long_list_.resize(place.bytes);
    file_.read_at(place.begin, long_list_);
    long_begin_ = place.begin;
    return long_list_;
  }
  Slot& slot = slots_[arc % kSlots];
  const std::span<std::byte> bytes = std::span(slot.bytes).first(place.bytes);
  if (slot.begin != place.begin) {
    slot.begin = kNowhere;
    file_.read_at(place.begin, bytes);
    slot.begin = place.begin;
  }
  return bytes;
}

void StoredLists::replace(std::size_t arc, std::span<const std::byte> packed) {
  const ArcId id(static_cast<std::uint32_t>(arc));
  if (packed.empty()) {
    places_[id] = {};
    return;
  }
  if (!buffer_.empty() && buffer_.size() + packed.size() > kBufferBytes) {
    if (!file_.is_open()) file_ = temp_->create_unnamed("lists of buckets");
    file_.write_at(written_, buffer_);
    written_ += buffer_.size();
    buffer_.clear();
  }
  places_[id] = {written_ + buffer_.size(), packed.size()};
  buffer_.insert(buffer_.end(), packed.begin(), packed.end());
}

}  // namespace reeb::ooc
