#include "io/file/checksum.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <vector>

#include "io/file/file.h"

namespace reeb::io {

struct RunningChecksum::State {
  XXH64_state_t hash;
};

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed) {
  return XXH64(bytes.data(), bytes.size(), seed);
}

std::uint64_t checksum_of(const File& file, std::uint64_t begin, std::uint64_t bytes) {
  std::vector<std::byte> piece(1 << 20);
  RunningChecksum checksum;
  for (const std::uint64_t end = begin + bytes; begin < end; begin += piece.size()) {
    piece.resize(static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), end - begin)));
    file.read_at(begin, piece);
    checksum.add(piece);
  }
  return checksum.value();
}

RunningChecksum::RunningChecksum() : state_(std::make_unique<State>()) { XXH64_reset(&state_->hash, 0); }
RunningChecksum::~RunningChecksum() = default;
RunningChecksum::RunningChecksum(RunningChecksum&&) noexcept = default;
RunningChecksum& RunningChecksum::operator=(RunningChecksum&&) noexcept = default;

void RunningChecksum::add(std::span<const std::byte> bytes) {
  if (!bytes.empty()) XXH64_update(&state_->hash, bytes.data(), bytes.size());
}

std::uint64_t RunningChecksum::value() const { return XXH64_digest(&state_->hash); }

struct RunningDigest::State {
  alignas(64) XXH3_state_t hash;
};

RunningDigest::RunningDigest() : state_(std::make_unique<State>()) { XXH3_64bits_reset(&state_->hash); }
RunningDigest::~RunningDigest() = default;
RunningDigest::RunningDigest(RunningDigest&&) noexcept = default;
RunningDigest& RunningDigest::operator=(RunningDigest&&) noexcept = default;

void RunningDigest::add(std::span<const std::byte> bytes) {
  if (!bytes.empty()) XXH3_64bits_update(&state_->hash, bytes.data(), bytes.size());
}

std::uint64_t RunningDigest::value() const { return XXH3_64bits_digest(&state_->hash); }

}  // namespace reeb::io
