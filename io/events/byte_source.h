// Bytes in, and a window over them: how every streaming mesh reader sees its input.
//
// A source hands out large pieces; the window keeps the piece being parsed contiguous, so that
// decoding never makes a virtual call a byte. Memory: the largest span ever asked of ensure(),
// at least kWindowBytes, and only ever as much as the input really delivered.
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

  // Fills a part of `out` and returns its size; 0 only at the end of the input.
  virtual std::size_t read(std::span<std::byte> out) = 0;
  // How much of the input was consumed, in bytes as it lies on disk.
  virtual std::uint64_t consumed() const = 0;
  // Number of bytes that read() will deliver in all, where that is known beforehand.
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

// A contiguous look at the bytes that come next.
class ByteWindow {
 public:
  static constexpr std::size_t kWindowBytes = 1u << 18;

  explicit ByteWindow(ByteSource& source) : source_(source) {}

  // Tries to make at least `count` bytes available; false if the input ends before. What data()
  // returned before is void after a call that had to read.
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
