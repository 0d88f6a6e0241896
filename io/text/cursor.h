// A position in a ContentSource that moves forward. All text and binary decoders are built on it.
//
// On a pipe, nothing waits for more bytes than it was asked for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "io/file/content_source.h"
#include "libreeb/base/error.h"

namespace reeb::io {

class Cursor {
 public:
  explicit Cursor(std::unique_ptr<ContentSource> source) : source_(std::move(source)) {}

  // Offset of the next byte in the content.
  std::uint64_t offset() const { return view_offset_ + static_cast<std::uint64_t>(next_ - view_.data()); }
  const ContentSource& source() const { return *source_; }
  // Bytes of the input consumed so far, as stored on disk.
  std::uint64_t bytes_read() const { return source_->can_seek() ? offset() : source_->file_bytes_read(); }

  // Makes at least `count` bytes contiguous at data(), or all the remaining ones if there are fewer; false in that
  // case. Invalidates what data() returned before, if it has to read.
  // REQUIRES: 1 <= count <= ContentSource::kLookahead.
  bool ensure(std::size_t count) {
    if (available() >= count) [[likely]]
      return true;
    view_at(offset(), count);
    return available() >= count;
  }
  std::size_t available() const { return static_cast<std::size_t>(end_ - next_); }
  const char* data() const { return next_; }
  // REQUIRES: count <= available().
  void advance(std::size_t count) { next_ += count; }

  // REQUIRES: source().can_seek(), or `offset` is not before the current one and within view.
  void move_to(std::uint64_t offset) { view_at(offset, 1); }
  // As move_to(); on content that cannot seek, also beyond the view, or to the end.
  void move_forward(std::uint64_t offset) {
    if (source_->can_seek()) return move_to(offset);
    while (this->offset() < offset && ensure(1))
      advance(static_cast<std::size_t>(std::min<std::uint64_t>(available(), offset - this->offset())));
  }
  bool at_end() { return !ensure(1); }

 private:
  void view_at(std::uint64_t offset, std::size_t min_bytes) {
    view_ = source_->view(offset, min_bytes);
    view_offset_ = offset;
    next_ = view_.data();
    end_ = next_ + view_.size();
  }

  std::unique_ptr<ContentSource> source_;
  std::string_view view_;
  std::uint64_t view_offset_ = 0;
  const char* next_ = nullptr;
  const char* end_ = nullptr;
};

}  // namespace reeb::io
