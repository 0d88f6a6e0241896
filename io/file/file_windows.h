// A file seen through a few windows, so that memory never grows with the file.
//
// The file is divided into windows of equal size. Each is read when it is first touched, with `overlap_bytes` of the
// next window, so that a record across a border is still contiguous. It replaces one that has not been used recently. A
// hit costs a shift and two table lookups.
//
// Windows are copies. A mapping would follow the file when that changes, and end the process when it shrinks.
//
// MEMORY: the windows, and one byte per window of the file: 4 MB per terabyte at the default size.
// THREADS: one at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/input_file.h"

namespace reeb::io {

struct WindowOptions {
  unsigned window_bits = 18;          // a window has 2^window_bits bytes
  std::size_t window_count = 4;       // held at once, 2 to 255
  std::size_t overlap_bytes = 65536;  // the longest record that at() guarantees
};

class FileWindows {
 public:
  explicit FileWindows(std::shared_ptr<const InputFile> file, WindowOptions options = {});
  // Opens the file. THROWS: as InputFile.
  explicit FileWindows(const std::string& path, WindowOptions options = {})
      : FileWindows(std::make_shared<const InputFile>(path), options) {}

  std::uint64_t size() const { return file_->size(); }
  const std::shared_ptr<const InputFile>& file() const { return file_; }
  std::size_t overlap_bytes() const { return options_.overlap_bytes; }

  // The bytes from `offset` on: at least overlap_bytes(), or all up to the end of the file. Valid until `window_count -
  // 1` other windows are touched.
  // REQUIRES: offset < size(). THROWS: Error{kBadInput} if the file has become shorter, or cannot be read.
  const char* at(std::uint64_t offset) {
    const std::uint64_t window = offset >> options_.window_bits;
    std::uint8_t number = slot_of_[window];
    if (number == kNone) number = load(window);
    Slot& slot = slots_[number];
    slot.recent = true;
    return slot.bytes.get() + (offset & window_mask_);
  }

  // The same with its length: all bytes of the window from `offset` on.
  std::string_view view(std::uint64_t offset);

 private:
  struct Slot {
    std::unique_ptr<char[]> bytes;  // of the window; null: none was read yet
    bool recent = false;
    std::uint64_t window = 0;
  };
  static constexpr std::uint8_t kNone = 255;

  std::uint8_t load(std::uint64_t window);
  std::uint8_t victim();
  std::size_t bytes_of(std::uint64_t window) const;

  std::shared_ptr<const InputFile> file_;
  WindowOptions options_;
  std::uint64_t window_mask_ = 0;
  std::vector<std::uint8_t> slot_of_;  // by window
  std::vector<Slot> slots_;
  std::size_t hand_ = 0;
};

}  // namespace reeb::io
