// A mesh file in memory, for readers under sanitizers. Every view is a separate allocation of exactly its size and is
// freed by the next view, so a sanitizer notices a read out of bounds or of an old view.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "io/file/content_source.h"

namespace reeb::io {

class MemorySource final : public ContentSource {
 public:
  // A file that can seek and knows its size, or a pipe that gives little more than the requested bytes.
  enum class Kind { kFile, kPipe };

  MemorySource(std::string bytes, Kind kind) : ContentSource("input"), bytes_(std::move(bytes)), kind_(kind) {}
  using ContentSource::view;

  std::string_view view(std::uint64_t offset, std::size_t min_bytes) override {
    const std::size_t begin = static_cast<std::size_t>(std::min<std::uint64_t>(offset, bytes_.size()));
    const std::size_t wanted = can_seek() ? kLookahead : min_bytes + offset * 7 % 31;
    const std::size_t size = std::min(wanted, bytes_.size() - begin);
    read_ = std::max<std::uint64_t>(read_, begin + size);
    block_ = std::make_unique<char[]>(size);
    std::memcpy(block_.get(), bytes_.data() + begin, size);
    return {block_.get(), size};
  }
  bool can_seek() const override { return kind_ == Kind::kFile; }
  std::optional<std::uint64_t> size() const override {
    return can_seek() ? std::optional<std::uint64_t>(bytes_.size()) : std::nullopt;
  }
  std::uint64_t file_bytes_read() const override { return read_; }
  std::uint64_t file_bytes() const override { return can_seek() ? bytes_.size() : 0; }
  std::unique_ptr<ContentSource> reopen() const override {
    return can_seek() ? std::make_unique<MemorySource>(bytes_, kind_) : nullptr;
  }

 private:
  std::string bytes_;
  Kind kind_;
  std::unique_ptr<char[]> block_;
  std::uint64_t read_ = 0;
};

}  // namespace reeb::io
