#include "io/file/file_windows.h"

#include <algorithm>
#include <span>
#include <utility>

namespace reeb::io {

FileWindows::FileWindows(std::shared_ptr<const InputFile> file, WindowOptions options)
    : file_(std::move(file)), options_(options) {
  window_mask_ = (std::uint64_t{1} << options_.window_bits) - 1;
  slot_of_.resize((size() >> options_.window_bits) + 1, kNone);
  slots_.resize(std::clamp<std::size_t>(options_.window_count, 2, kNone));
}

std::string_view FileWindows::view(std::uint64_t offset) {
  const char* const begin = at(offset);
  return {begin, bytes_of(offset >> options_.window_bits) - static_cast<std::size_t>(offset & window_mask_)};
}

std::size_t FileWindows::bytes_of(std::uint64_t window) const {
  const std::uint64_t wanted = window_mask_ + 1 + options_.overlap_bytes;
  return static_cast<std::size_t>(std::min(wanted, size() - (window << options_.window_bits)));
}

// The clock rule: the hand skips windows that were used since its last visit.
std::uint8_t FileWindows::victim() {
  while (true) {
    const auto number = static_cast<std::uint8_t>(hand_);
    Slot& slot = slots_[number];
    hand_ = (hand_ + 1) % slots_.size();
    if (!slot.bytes) {
      slot.bytes = std::make_unique_for_overwrite<char[]>(bytes_of(0));
      return number;
    }
    if (!slot.recent) {
      slot_of_[slot.window] = kNone;
      return number;
    }
    slot.recent = false;
  }
}

std::uint8_t FileWindows::load(std::uint64_t window) {
  const std::uint8_t number = victim();
  Slot& slot = slots_[number];
  const std::span<char> bytes(slot.bytes.get(), bytes_of(window));
  file_->read_at(window << options_.window_bits, std::as_writable_bytes(bytes));
  slot.window = window;
  slot_of_[window] = number;
  return number;
}

}  // namespace reeb::io
