#include "ooc/segmentation/event_log.h"

#include <span>

#include "libreeb/base/error.h"

namespace reeb::ooc {

EventLog::EventLog(const io::TempDir& temp, MemoryBudget& budget, PlacedVertices* placed)
    : charge_(budget.reserve("history of arcs", kBlockBytes)),
      file_(temp.create_unnamed("history of arcs")),
      placed_(placed),
      block_(kBlockBytes) {}

std::uint32_t EventLog::settle_unnamed(std::uint32_t count) {
  if (count >= ArcHistory::kDropped - settled_)
    throw Error(ErrorKind::kResource, "the graph has too many arcs for segmentation", "use a smoother function");
  const std::uint32_t first = settled_;
  settled_ += count;
  return first;
}

ArcEvent EventLog::take_last() {
  using enum ArcEvent::Kind;
  const auto tag = std::to_integer<unsigned>(block_[--filled_]);
  ArcEvent event{.kind = static_cast<ArcEvent::Kind>(tag >> 1), .side = (tag & 1) != 0 ? kUp : kDown};
  const bool has_other = event.kind == kMerge || event.kind == kSettle;
  const bool has_both = event.kind == kCut || event.kind == kJoin || event.kind == kLay;
  if (event.kind == kPlace || has_both) take(event.key);
  if (has_other || has_both) take(event.other);
  take(event.arc);
  return event;
}

void EventLog::write_block() {
  file_.write_at(written_, std::span<const std::byte>(block_).first(filled_));
  const std::uint64_t length = filled_;
  file_.write_at(written_ + length, std::as_bytes(std::span(&length, 1)));
  written_ += length + sizeof length;
  filled_ = 0;
}

bool EventLog::fetch_block_before() {
  if (written_ == 0) return false;
  std::uint64_t length = 0;
  file_.read_at(written_ - sizeof length, std::as_writable_bytes(std::span(&length, 1)));
  written_ -= sizeof length + length;
  filled_ = static_cast<std::size_t>(length);
  file_.read_at(written_, std::span(block_).first(filled_));
  return true;
}

}  // namespace reeb::ooc
