// The fixed objects of a `.reeb` file: header region, frame header, tail (docs/FORMAT.md).
//
// One struct an object; encode appends its bytes, decode reads a span and returns null, or says in
// a few words what is wrong with it. Checksums are laid around these bytes by the file layer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/format/file_header.h"

namespace reeb {

// The first and the last eight bytes of every file. The first is chosen like PNG's: a transfer that
// drops the high bit or turns line ends shows at once.
inline constexpr std::array<std::uint8_t, 8> kReebMagic = {0x89, 'R', 'E', 'E', 'B', '\r', '\n', 0x1a};
inline constexpr std::array<std::uint8_t, 8> kReebEndMagic = {'R', 'E', 'E', 'B', 'E', 'N', 'D', '\n'};
inline constexpr std::uint32_t kReebVersion = 1;

inline constexpr std::size_t kFixedHeaderBytes = 176;
inline constexpr std::size_t kLevelBytes = 56;
inline constexpr std::size_t kChecksumBytes = 8;
inline constexpr std::size_t kFrameHeaderBytes = 40;  // its checksum included
inline constexpr std::size_t kTailBytes = 24;
inline constexpr std::uint32_t kMaxNameBytes = 4096;
inline constexpr std::uint32_t kMaxFrameBytes = 16u << 20;  // uncompressed

// The header region without its checksum.
void encode_header(const FileHeader& header, std::vector<std::byte>& out);

// Size of the whole region, from its first kFixedHeaderBytes bytes.
const char* decode_region_bytes(std::span<const std::byte> fixed_part, std::uint64_t& region_bytes);
// REQUIRES: `region` is what decode_region_bytes announced, without the checksum.
const char* decode_header(std::span<const std::byte> region, FileHeader& header);

enum class FrameKind : std::uint32_t { kGraph = 1, kPairs = 2 };

struct FrameHeader {
  FrameKind kind = FrameKind::kGraph;
  std::uint32_t stored_bytes = 0;  // of the payload; equal to raw_bytes: it is not compressed
  std::uint32_t raw_bytes = 0;
  std::uint32_t nodes = 0;     // introduced here; in a pairs frame, the pairs
  std::uint32_t records = 0;   // arc records
  std::uint32_t versions = 0;  // that this frame completes
  std::uint32_t finest = 0;    // the finest complete version; steps + 1: none is
  std::uint32_t reserved = 0;
  friend bool operator==(const FrameHeader&, const FrameHeader&) = default;
};

// The frame header without its checksum (which also covers the payload).
void encode_frame_header(const FrameHeader& header, std::vector<std::byte>& out);
const char* decode_frame_header(std::span<const std::byte> bytes, FrameHeader& header);

// The least threshold t at which all cancellations up to one of this persistence are done: the next
// number above it, as cancelling below t is strict. Version 0 has threshold 0.
double level_threshold(std::uint32_t version, double persistence) noexcept;

}  // namespace reeb
