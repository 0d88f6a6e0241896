#include "io/file/mapped_windows.h"

#include <algorithm>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb::io {

MappedWindows::MappedWindows(std::shared_ptr<const MappableFile> file, WindowOptions options)
    : file_(std::move(file)), options_(options) {
  window_mask_ = (std::uint64_t{1} << options_.window_bits) - 1;
  slot_of_.resize((size() >> options_.window_bits) + 1, kNone);
  slots_.resize(std::clamp<std::size_t>(options_.window_count, 2, kNone));
}

std::string_view MappedWindows::view(std::uint64_t offset) {
  const char* const begin = at(offset);
  return {begin, mapped_bytes(offset >> options_.window_bits) - static_cast<std::size_t>(offset & window_mask_)};
}

std::size_t MappedWindows::mapped_bytes(std::uint64_t window) const {
  const std::uint64_t wanted = window_mask_ + 1 + options_.overlap_bytes;
  return static_cast<std::size_t>(std::min(wanted, size() - (window << options_.window_bits)));
}

// The clock rule: the hand skips windows that were used since its last visit.
std::uint8_t MappedWindows::victim() {
  while (true) {
    const auto number = static_cast<std::uint8_t>(hand_);
    Slot& slot = slots_[number];
    hand_ = (hand_ + 1) % slots_.size();
    if (slot.map.bytes().empty()) return number;
    if (!slot.recent) {
      slot_of_[slot.window] = kNone;
      slot.map = {};
      return number;
    }
    slot.recent = false;
  }
}

std::uint8_t MappedWindows::map(std::uint64_t window) {
  const std::uint8_t number = victim();
  Slot& slot = slots_[number];
  slot.map = file_->map(window << options_.window_bits, mapped_bytes(window));
  slot.base = reinterpret_cast<const char*>(slot.map.bytes().data());
  slot.window = window;
  slot_of_[window] = number;
  return number;
}

}  // namespace reeb::io
