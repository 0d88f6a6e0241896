// States (libreeb/base/state_stream.h) in files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/file/buffered_writer.h"
#include "io/file/checksum.h"
#include "io/file/file.h"
#include "libreeb/base/state_stream.h"

namespace reeb::ooc {

// Whether `path` is a regular file that begins with `magic`. THROWS: as io::File.
bool begins_with(const std::string& path, const std::array<char, 8>& magic);

// Appends to `out`, which must outlive it, and adds up what it appends. THROWS: as `out`.
class StateFileWriter : public StateWriter {
 public:
  explicit StateFileWriter(io::BufferedWriter& out) : out_(out) {}

  void write(std::span<const std::byte> bytes) override;
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t checksum() const { return checksum_.value(); }

 private:
  io::BufferedWriter& out_;
  io::RunningChecksum checksum_;
  std::uint64_t bytes_ = 0;
};

// Reads the bytes of `file`, which must outlive it, from `begin` to `end`. Fields are read many at a time, and large
// arrays in one call. THROWS: DamagedState beyond the end, and as `file`.
class StateFileReader : public StateReader {
 public:
  StateFileReader(const io::File& file, std::uint64_t begin, std::uint64_t end) : file_(file), at_(begin), end_(end) {}

  void read(std::span<std::byte> bytes) override;
  std::uint64_t left() const override { return end_ - at_ + (window_.size() - used_); }

 private:
  static constexpr std::size_t kWindowBytes = 64 << 10;

  const io::File& file_;
  std::uint64_t at_, end_;
  std::vector<std::byte> window_;
  std::size_t used_ = 0;
};

}  // namespace reeb::ooc
