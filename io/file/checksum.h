// XXH64 with seed 0: the checksum of every file that this project writes. XXH3: the digest of what it reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

namespace reeb::io {

class File;

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0);

// THROWS: Error, of reading the file.
std::uint64_t checksum_of(const File& file, std::uint64_t begin, std::uint64_t bytes);

// An object as it is stored.
template <class T>
std::span<const std::byte> object_bytes(const T& object) {
  static_assert(std::is_trivially_copyable_v<T>);
  return std::as_bytes(std::span(&object, 1));
}

// Of a header that ends with its checksum: that of the bytes before.
template <class Header>
std::uint64_t header_checksum(const Header& header) {
  return checksum(object_bytes(header).first(sizeof(Header) - sizeof(std::uint64_t)));
}

// The checksum of bytes that arrive in parts. It does not depend on where they were cut.
class RunningChecksum {
 public:
  RunningChecksum();
  ~RunningChecksum();
  RunningChecksum(RunningChecksum&&) noexcept;
  RunningChecksum& operator=(RunningChecksum&&) noexcept;

  void add(std::span<const std::byte> bytes);
  std::uint64_t value() const;  // of all bytes so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// XXH3 of bytes that arrive in parts: a digest of a whole mesh, at several times the speed of XXH64.
class RunningDigest {
 public:
  RunningDigest();
  ~RunningDigest();
  RunningDigest(RunningDigest&&) noexcept;
  RunningDigest& operator=(RunningDigest&&) noexcept;

  void add(std::span<const std::byte> bytes);
  std::uint64_t value() const;  // of all bytes so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace reeb::io
