#include "io/file/buffered_writer.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace reeb::io {
namespace {

// An output goes to the device in parts of this size. So the device is busy before sync() waits for it.
constexpr std::uint64_t kSyncBytes = std::uint64_t{16} << 20;

}  // namespace

BufferedWriter::BufferedWriter(File file, std::size_t buffer_bytes)
    : file_(std::move(file)),
      buffer_bytes_(buffer_bytes),
      buffer_(std::make_unique_for_overwrite<char[]>(buffer_bytes)) {}

void BufferedWriter::append(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    if (filled_ == 0 && bytes.size() >= buffer_bytes_) return write_out(bytes);
    const std::size_t part = std::min(bytes.size(), buffer_bytes_ - filled_);
    std::memcpy(buffer_.get() + filled_, bytes.data(), part);
    filled_ += part;
    bytes = bytes.subspan(part);
    if (filled_ == buffer_bytes_) flush();
  }
}

void BufferedWriter::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) {
  flush();
  file_.write_at(offset, bytes);
}

void BufferedWriter::append_file(BufferedWriter& other) {
  other.flush();
  flush();
  for (std::uint64_t offset = 0; offset < other.flushed_;) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_bytes_, other.flushed_ - offset));
    other.file_.read_at(offset, std::as_writable_bytes(std::span(buffer_.get(), part)));
    filled_ = part;
    offset += part;
    flush();
  }
}

void BufferedWriter::flush() { write_out(std::as_bytes(std::span(buffer_.get(), std::exchange(filled_, 0)))); }

void BufferedWriter::write_out(std::span<const std::byte> bytes) {
  file_.write_next(flushed_, bytes);
  flushed_ += bytes.size();
  if (flushed_ - syncing_ < kSyncBytes) return;
  file_.start_sync(syncing_, flushed_ - syncing_);
  syncing_ = flushed_;
}

void BufferedWriter::sync() {
  flush();
  file_.sync();
}

}  // namespace reeb::io
