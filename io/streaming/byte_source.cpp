#include "io/streaming/byte_source.h"

#include <algorithm>
#include <cstring>

namespace reeb::io {

IstreamSource::IstreamSource(std::istream& in, std::optional<std::uint64_t> size)
    : in_(in), size_(size) {}

std::size_t IstreamSource::read(std::span<std::byte> out) {
  in_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
  const auto count = static_cast<std::size_t>(in_.gcount());
  consumed_ += count;
  return count;
}

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
    // Doubling, never straight to `count`: the memory follows the data, not a number in a header.
    if (end_ == buffer_.size()) buffer_.resize(std::max(kWindowBytes, 2 * buffer_.size()));
    const std::size_t got = source_.read(std::span(buffer_).subspan(end_));
    if (got == 0) return false;
    end_ += got;
    end_position_ += got;
  }
  return true;
}

}  // namespace reeb::io
