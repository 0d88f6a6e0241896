// Decompresses gzip and zstd while the input is read, with Boost.Iostreams filters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace reeb::io {

// Bytes in order, with a count.
class RawInput {
 public:
  RawInput() = default;
  RawInput(const RawInput&) = delete;
  RawInput& operator=(const RawInput&) = delete;
  virtual ~RawInput() = default;

  // Reads at most `limit` bytes and returns their number; 0 only at the end.
  virtual std::size_t read(char* out, std::size_t limit) = 0;
  // Bytes consumed so far, as stored in the file.
  virtual std::uint64_t consumed() const = 0;
  // What it holds to unpack: little, unless the file was packed with a large window.
  virtual std::uint64_t memory_bytes() const { return 0; }
};

enum class Compression { kNone, kGzip, kZstd };

// By the first bytes. If a file was cut so short that they do not tell, its name does.
Compression detect_compression(std::string_view first_bytes, const std::string& name);

// The content of `raw`: any number of gzip members or zstd frames, one after the other.
// read() THROWS: Error{kBadInput} with `name` and the byte offset in the compressed file where the
// stream is damaged or ends too early.
std::unique_ptr<RawInput> decompress(const std::string& name, std::unique_ptr<RawInput> raw, Compression compression);

}  // namespace reeb::io
