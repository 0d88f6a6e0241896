// The input of every streaming mesh reader: a source of bytes, and a window over them.
//
// A source is read in large blocks. The window keeps the bytes being parsed contiguous, so that decoding makes no
// virtual call per byte.
// MEMORY: kWindowBytes, or up to twice the largest span that ensure() delivered. A size that is only announced takes
// none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace reeb::io {

class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  // Fills the beginning of `out` and returns the number of bytes; 0 only at the end of the input.
  virtual std::size_t read(std::span<std::byte> out) = 0;
  // Bytes of the input consumed so far, as stored on disk (before decompression).
  virtual std::uint64_t consumed() const = 0;
  // Total number of bytes that read() delivers, if known beforehand.
  virtual std::optional<std::uint64_t> size() const { return {}; }
};

// Bytes in memory, which must outlive the source.
class SpanSource : public ByteSource {
 public:
  explicit SpanSource(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::size_t read(std::span<std::byte> out) override;
  std::uint64_t consumed() const override { return at_; }
  std::optional<std::uint64_t> size() const override { return bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

// A contiguous view of the next bytes.
class ByteWindow {
 public:
  static constexpr std::size_t kWindowBytes = 1u << 18;

  explicit ByteWindow(ByteSource& source) : source_(source) {}

  // Tries to make at least `count` bytes available; false if the input ends before. A call that has to read invalidates
  // what data() returned before.
  bool ensure(std::size_t count) { return available() >= count || refill(count); }
  std::size_t available() const { return end_ - begin_; }
  const std::byte* data() const { return buffer_.data() + begin_; }
  // REQUIRES: count <= available().
  void skip(std::size_t count) { begin_ += count; }
  // Offset of data() from the start of the input.
  std::uint64_t position() const { return end_position_ - available(); }
  std::optional<std::uint64_t> source_size() const { return source_.size(); }

 private:
  bool refill(std::size_t count);

  ByteSource& source_;
  std::vector<std::byte> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t end_position_ = 0;
};

}  // namespace reeb::io
