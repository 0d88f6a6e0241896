// Bytes in memory, as the content of a file or of a pipe.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "io/file/content_source.h"

namespace reeb::test {

// The bytes must outlive it.
class BytesSource : public io::ContentSource {
 public:
  // A file, all of which is in view.
  explicit BytesSource(std::string_view bytes) : bytes_(bytes), step_(bytes.size()) {}
  // A slow pipe: gives `step` bytes at a time, or as many as it is asked for.
  BytesSource(std::string_view bytes, std::size_t step) : bytes_(bytes), step_(step), pipe_(true) {}
  using ContentSource::view;

  std::string_view view(std::uint64_t offset, std::size_t min_bytes) override {
    const std::size_t begin = static_cast<std::size_t>(std::min<std::uint64_t>(offset, bytes_.size()));
    const std::string_view seen = bytes_.substr(begin, std::max(step_, min_bytes));
    read_ = std::max<std::uint64_t>(read_, begin + seen.size());
    return seen;
  }
  bool can_seek() const override { return !pipe_; }
  std::optional<std::uint64_t> size() const override {
    return pipe_ ? std::nullopt : std::optional<std::uint64_t>(bytes_.size());
  }
  std::uint64_t file_bytes_read() const override { return read_; }
  std::uint64_t file_bytes() const override { return pipe_ ? 0 : bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t step_;
  bool pipe_ = false;
  std::uint64_t read_ = 0;
};

}  // namespace reeb::test
