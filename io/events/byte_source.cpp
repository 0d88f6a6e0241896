#include "io/events/byte_source.h"

#include <algorithm>
#include <cstring>

namespace reeb::io {

std::size_t SpanSource::read(std::span<std::byte> out) {
  const std::size_t count = std::min(out.size(), bytes_.size() - at_);
  if (count != 0) std::memcpy(out.data(), bytes_.data() + at_, count);
  at_ += count;
  return count;
}

bool ByteWindow::refill(std::size_t count) {
  if (begin_ != 0) {
    std::memmove(buffer_.data(), data(), available());
    end_ -= begin_;
    begin_ = 0;
  }
  while (available() < count) {
    // Doubles instead of growing to `count` at once: memory follows the data, not a number in a header.
    if (end_ == buffer_.size()) buffer_.resize(std::max(kWindowBytes, 2 * buffer_.size()));
    const std::size_t got = source_.read(std::span(buffer_).subspan(end_));
    if (got == 0) return false;
    end_ += got;
    end_position_ += got;
  }
  return true;
}

}  // namespace reeb::io
