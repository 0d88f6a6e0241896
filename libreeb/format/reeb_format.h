// The fixed objects of a `.reeb` file: header region, frame header, tail (docs/FORMAT.md).
//
// Each object is a struct. Its encode function appends its bytes; its decode function reads a span, and returns null or
// a few words that say what is wrong. The file layer adds the checksums.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libreeb/format/file_header.h"

namespace reeb {

// The first and the last eight bytes of every file. The first are chosen as in PNG: they reveal a transfer that drops
// the high bit or converts line ends.
inline constexpr std::array<std::uint8_t, 8> kReebMagic = {0x89, 'R', 'E', 'E', 'B', '\r', '\n', 0x1a};
inline constexpr std::array<std::uint8_t, 8> kReebEndMagic = {'R', 'E', 'E', 'B', 'E', 'N', 'D', '\n'};
// Files with spreads have the newer version, all others, also if they are written now, the older one.
inline constexpr std::uint32_t kReebVersion = 1, kReebVersionWithSpreads = 2;

inline constexpr std::size_t kFixedHeaderBytes = 176;
inline constexpr std::size_t kLevelBytes = 56;
inline constexpr std::size_t kChecksumBytes = 8;
inline constexpr std::size_t kFrameHeaderBytes = 40;  // its checksum included
inline constexpr std::size_t kTailBytes = 24;
inline constexpr std::uint32_t kMaxNameBytes = 4096;
inline constexpr std::uint32_t kMaxFrameBytes = 128u << 20;  // uncompressed; an arc may have two million buckets

// The header region without its checksum.
void encode_header(const FileHeader& header, std::vector<std::byte>& out);

// The version of a file that begins like a `.reeb` file, if it is none of those above.
std::optional<std::uint32_t> unknown_version(std::span<const std::byte> fixed_part);

// Reads the size of the whole region from its first kFixedHeaderBytes bytes.
const char* decode_region_bytes(std::span<const std::byte> fixed_part, std::uint64_t& region_bytes);
// REQUIRES: `region` has the size that decode_region_bytes found, without the checksum.
const char* decode_header(std::span<const std::byte> region, FileHeader& header);

enum class FrameKind : std::uint32_t { kGraph = 1, kPairs = 2 };

struct FrameHeader {
  FrameKind kind = FrameKind::kGraph;
  std::uint32_t stored_bytes = 0;  // of the payload; if equal to raw_bytes, it is not compressed
  std::uint32_t raw_bytes = 0;
  std::uint32_t nodes = 0;     // introduced here; in a pairs frame, the pairs
  std::uint32_t records = 0;   // arc records
  std::uint32_t versions = 0;  // that this frame completes
  std::uint32_t finest = 0;    // the finest complete version; steps + 1 if there is none
  std::uint32_t reserved = 0;
  friend bool operator==(const FrameHeader&, const FrameHeader&) = default;
};

// The frame header without its checksum (which also covers the payload).
void encode_frame_header(const FrameHeader& header, std::vector<std::byte>& out);
const char* decode_frame_header(std::span<const std::byte> bytes, FrameHeader& header);

// The least threshold that yields a version whose last cancellation has this persistence: the next number above it,
// since a pair is cancelled only if its persistence is less than the threshold. Version 0 has threshold 0.
double level_threshold(std::uint32_t version, double persistence) noexcept;

}  // namespace reeb
