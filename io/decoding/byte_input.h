// Bytes of a file, one stage after the other: the content, unpacked, decoded.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "io/file/content_source.h"

namespace reeb::io {

class ByteInput {
 public:
  ByteInput() = default;
  ByteInput(const ByteInput&) = delete;
  ByteInput& operator=(const ByteInput&) = delete;
  virtual ~ByteInput() = default;

  // Reads at most `limit` bytes and returns their number; 0 only at the end. REQUIRES: limit > 0.
  virtual std::size_t read(char* out, std::size_t limit) = 0;
  // The content of the file, for messages: its name, and where the next byte is, or the bytes that it is made of.
  virtual const std::string& name() const = 0;
  virtual std::uint64_t offset() const = 0;
  // Bytes consumed of the file as stored on disk.
  virtual std::uint64_t file_bytes_read() const = 0;
  // What it holds beyond buffers of fixed size.
  virtual std::uint64_t memory_bytes() const { return 0; }
};

// A stage that makes other bytes of those of the stage before it.
class ByteFilter : public ByteInput {
 public:
  explicit ByteFilter(std::unique_ptr<ByteInput> input) : input_(std::move(input)) {}

  const std::string& name() const final { return input_->name(); }
  std::uint64_t offset() const override { return input_->offset(); }
  std::uint64_t file_bytes_read() const final { return input_->file_bytes_read(); }
  std::uint64_t memory_bytes() const override { return input_->memory_bytes(); }

 protected:
  ByteInput& input() { return *input_; }

 private:
  std::unique_ptr<ByteInput> input_;
};

// The content from an offset on.
class ContentBytes final : public ByteInput {
 public:
  // REQUIRES: `offset` is at least source->least_offset().
  ContentBytes(std::unique_ptr<ContentSource> source, std::uint64_t offset)
      : source_(std::move(source)), offset_(source_->can_seek() ? offset : source_->least_offset()) {
    // A pipe is read up to there.
    while (offset_ < offset) {
      const std::size_t seen = source_->view(offset_, 1).size();
      if (seen == 0) break;
      offset_ += std::min<std::uint64_t>(seen, offset - offset_);
    }
  }

  std::size_t read(char* out, std::size_t limit) override {
    const std::string_view bytes = source_->view(offset_, 1).substr(0, limit);
    std::ranges::copy(bytes, out);
    offset_ += bytes.size();
    return bytes.size();
  }
  const std::string& name() const override { return source_->name(); }
  std::uint64_t offset() const override { return offset_; }
  std::uint64_t file_bytes_read() const override { return source_->can_seek() ? offset_ : source_->file_bytes_read(); }
  std::uint64_t memory_bytes() const override { return source_->memory_bytes(); }

 private:
  std::unique_ptr<ContentSource> source_;
  std::uint64_t offset_;
};

}  // namespace reeb::io
