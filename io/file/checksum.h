// XXH64 with seed 0: the checksum of every file that this project writes. XXH3: the digest of what it reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace reeb::io {

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0);

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
