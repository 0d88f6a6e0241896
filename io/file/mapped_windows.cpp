#include "io/file/mapped_windows.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <system_error>

#include "io/file/input_file.h"
#include "libreeb/base/error.h"

namespace reeb::io {

MappedWindows::MappedWindows(const std::string& path, WindowOptions options) : path_(path), options_(options) {
  check_input_file(path);
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure))
    throw Error(ErrorKind::kBadInput, "is not a regular file, so it cannot be mapped",
                "copy it to a regular file first")
        .at(path);
  size_ = std::filesystem::file_size(path, failure);
  if (failure) throw Error(ErrorKind::kBadInput, "cannot be read: " + failure.message(), "check the file").at(path);
  if (size_ == 0) throw_empty(path);
  window_mask_ = (std::uint64_t{1} << options_.window_bits) - 1;
  slot_of_.resize((size_ >> options_.window_bits) + 1, kNone);
  slots_.resize(std::clamp<std::size_t>(options_.window_count, 2, kNone));
}

std::string_view MappedWindows::view(std::uint64_t offset) {
  const char* const begin = at(offset);
  return {begin, mapped_bytes(offset >> options_.window_bits) - static_cast<std::size_t>(offset & window_mask_)};
}

std::size_t MappedWindows::mapped_bytes(std::uint64_t window) const {
  const std::uint64_t wanted = window_mask_ + 1 + options_.overlap_bytes;
  return static_cast<std::size_t>(std::min(wanted, size_ - (window << options_.window_bits)));
}

// The clock rule: the hand passes over windows used since it came by last.
std::uint8_t MappedWindows::victim() {
  while (true) {
    const auto number = static_cast<std::uint8_t>(hand_);
    Slot& slot = slots_[number];
    hand_ = (hand_ + 1) % slots_.size();
    if (!slot.map.is_open()) return number;
    if (!slot.recent) {
      slot_of_[slot.window] = kNone;
      slot.map.close();
      return number;
    }
    slot.recent = false;
  }
}

std::uint8_t MappedWindows::map(std::uint64_t window) {
  const std::uint8_t number = victim();
  Slot& slot = slots_[number];
  try {
    slot.map.open(path_, mapped_bytes(window),
                  static_cast<boost::iostreams::stream_offset>(window << options_.window_bits));
  } catch (const std::exception& failure) {
    throw Error(ErrorKind::kResource, std::string("cannot be mapped: ") + failure.what(),
                "check that the file is still there and that memory is left")
        .at(path_, std::to_string(window << options_.window_bits));
  }
  slot.base = slot.map.data();
  slot.window = window;
  slot_of_[window] = number;
  return number;
}

}  // namespace reeb::io
