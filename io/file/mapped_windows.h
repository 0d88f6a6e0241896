// A file seen through a few mapped windows, so that resident memory never grows with the file
// (DESIGN.md 4, Reading).
//
// The file is divided into windows of equal size. Each is mapped when first touched, together with
// `overlap` bytes of its successor, so that a record that crosses a border is still contiguous; the
// window that was longest without use is unmapped for it. A hit costs a shift and two table lookups.
//
// The table takes a byte a window of the file: 4 MB a terabyte at the default size.
// The size is checked when the file is opened; a file cut by someone else while it is being read
// ends the process with SIGBUS, so inputs must not change meanwhile.
// THREADS: one at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/file.h"
#include "io/file/input_file.h"

namespace reeb::io {

struct WindowOptions {
  unsigned window_bits = 18;          // windows of 2^bits bytes, at least the page size
  std::size_t window_count = 4;       // mapped at once, 2 to 255
  std::size_t overlap_bytes = 65536;  // longest record that at() can be asked for
};

class MappedWindows {
 public:
  explicit MappedWindows(std::shared_ptr<const MappableFile> file, WindowOptions options = {});
  // Opens the file. THROWS: as MappableFile.
  explicit MappedWindows(const std::string& path, WindowOptions options = {})
      : MappedWindows(std::make_shared<const MappableFile>(path), options) {}

  std::uint64_t size() const { return file_->size(); }
  const std::shared_ptr<const MappableFile>& file() const { return file_; }
  std::size_t overlap_bytes() const { return options_.overlap_bytes; }

  // The bytes from `offset` on: at least overlap_bytes(), or all up to the end of the file. Valid
  // until `window_count - 1` other windows were touched.
  // REQUIRES: offset < size(). THROWS: Error{kResource} if the system refuses the mapping.
  const char* at(std::uint64_t offset) {
    const std::uint64_t window = offset >> options_.window_bits;
    std::uint8_t number = slot_of_[window];
    if (number == kNone) number = map(window);
    Slot& slot = slots_[number];
    slot.recent = true;
    return slot.base + (offset & window_mask_);
  }

  // The same with its length: all that is mapped behind `offset`.
  std::string_view view(std::uint64_t offset);

 private:
  struct Slot {
    const char* base = nullptr;  // of the window
    bool recent = false;
    std::uint64_t window = 0;
    Mapping map;
  };
  static constexpr std::uint8_t kNone = 255;

  std::uint8_t map(std::uint64_t window);
  std::uint8_t victim();
  std::size_t mapped_bytes(std::uint64_t window) const;

  std::shared_ptr<const MappableFile> file_;
  WindowOptions options_;
  std::uint64_t window_mask_ = 0;
  std::vector<std::uint8_t> slot_of_;  // by window
  std::vector<Slot> slots_;
  std::size_t hand_ = 0;
};

}  // namespace reeb::io
