#include "libreeb/format/reeb_format.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libreeb/base/byte_coding.h"

namespace reeb {
namespace {

constexpr std::uint32_t kGraphOnlyBit = 1, kPositionsBit = 2, kEmbeddingBit = 4;

std::uint32_t pack(const FileFlags& flags) {
  return (flags.graph_only ? kGraphOnlyBit : 0) | (flags.has_positions ? kPositionsBit : 0) |
         (flags.has_embedding ? kEmbeddingBit : 0);
}

FileFlags unpack(std::uint32_t bits, bool has_spreads) {
  return {(bits & kGraphOnlyBit) != 0, (bits & kPositionsBit) != 0, (bits & kEmbeddingBit) != 0, has_spreads};
}

bool starts_with(ByteReader& reader, std::span<const std::uint8_t> magic) {
  return std::ranges::all_of(magic, [&](std::uint8_t byte) { return reader.u8() == byte; });
}

void encode_level(const LevelLine& level, ByteWriter& out) {
  out.u32(level.version);
  out.u32(level.frames);
  out.f64(level.threshold);
  out.u64(level.nodes);
  out.u64(level.arcs);
  out.u64(level.buckets);
  out.u64(level.file_bytes);
  out.u64(level.memory_bytes);
}

// A bucket takes more memory now than when files of version 1 were written.
LevelLine decode_level(ByteReader& in, const FileFlags& flags) {
  constexpr std::uint64_t kFormerBucketMemoryBytes = 40;
  LevelLine level;
  level.version = in.u32();
  level.frames = in.u32();
  level.threshold = in.f64();
  level.nodes = in.u64();
  level.arcs = in.u64();
  level.buckets = in.u64();
  level.file_bytes = in.u64();
  level.memory_bytes = in.u64();
  if (!flags.has_spreads) level.memory_bytes += (kBucketMemoryBytes - kFormerBucketMemoryBytes) * level.buckets;
  return level;
}

// From coarse to fine, ending with the full graph, each within the file it describes.
const char* check_levels(const FileHeader& header) {
  if (header.levels.empty() || header.levels.back().version != 0) return "the level table lacks the full graph";
  const LevelLine* coarser = nullptr;
  for (const LevelLine& level : header.levels) {
    if (level.version > header.steps || level.frames == 0 || level.frames > header.graph_frames ||
        !(level.threshold >= 0))
      return "a line of the level table is out of range";
    if (coarser != nullptr &&
        (level.version >= coarser->version || level.frames < coarser->frames || level.threshold > coarser->threshold))
      return "the level table is not sorted from coarse to fine";
    coarser = &level;
  }
  return nullptr;
}

const char* check_header(const FileHeader& header) {
  if (!std::isfinite(header.function_min) || !std::isfinite(header.function_max) ||
      header.function_min > header.function_max)
    return "the range of the function is not a range";
  if (header.arcs + header.components - header.nodes != header.loops)
    return "nodes, arcs, components and loops do not agree";
  if (header.flags.graph_only && (header.steps != 0 || header.pairs != 0 || header.pair_frames != 0))
    return "a file without hierarchy announces cancellations or pairs";
  if (header.steps == std::numeric_limits<std::uint32_t>::max()) return "there are too many cancellations";
  return check_levels(header);
}

}  // namespace

std::uint64_t FileHeader::region_bytes() const {
  return kFixedHeaderBytes + function.size() + kLevelBytes * levels.size() + kChecksumBytes;
}

void encode_header(const FileHeader& header, std::vector<std::byte>& bytes) {
  ByteWriter out(bytes);
  for (const std::uint8_t byte : kReebMagic) out.u8(byte);
  out.u32(header.flags.has_spreads ? kReebVersionWithSpreads : kReebVersion);
  out.u32(pack(header.flags));
  out.u64(header.region_bytes());
  out.f64(header.function_min);
  out.f64(header.function_max);
  out.u64(header.mesh_vertices);
  out.u64(header.mesh_triangles);
  out.u64(header.nodes);
  out.u64(header.arcs);
  out.u64(header.components);
  out.u64(header.loops);
  out.u64(header.records);
  out.u64(header.pairs);
  out.u64(header.kept_loops);
  out.f64(header.denoise_threshold);
  out.u64(header.denoised_pairs);
  out.u64(header.content_digest);
  out.u32(static_cast<std::uint32_t>(header.bucket_exponent));
  out.u32(header.steps);
  out.u32(header.graph_frames);
  out.u32(header.pair_frames);
  out.u32(static_cast<std::uint32_t>(header.levels.size()));
  out.u32(static_cast<std::uint32_t>(header.function.size()));
  out.u64(0);
  out.u64(0);
  out.text(header.function);
  for (const LevelLine& level : header.levels) encode_level(level, out);
}

std::optional<std::uint32_t> unknown_version(std::span<const std::byte> fixed_part) {
  ByteReader in(fixed_part);
  if (!starts_with(in, kReebMagic)) return std::nullopt;
  const std::uint32_t version = in.u32();
  if (!in.ok() || version == kReebVersion || version == kReebVersionWithSpreads) return std::nullopt;
  return version;
}

const char* decode_region_bytes(std::span<const std::byte> fixed_part, std::uint64_t& region_bytes) {
  ByteReader in(fixed_part);
  if (!starts_with(in, kReebMagic)) return "this is not a .reeb file";
  if (unknown_version(fixed_part)) return "the format version is neither 1 nor 2";
  in.u32();
  in.u32();
  region_bytes = in.u64();
  if (!in.ok()) return "the file ends within its header";
  if (region_bytes < kFixedHeaderBytes + kChecksumBytes) return "the header's size is too small";
  return nullptr;
}

const char* decode_header(std::span<const std::byte> region, FileHeader& header) {
  std::uint64_t region_bytes = 0;
  if (const char* why = decode_region_bytes(region, region_bytes)) return why;
  ByteReader in(region);
  in.u64();
  const std::uint32_t version = in.u32();
  const std::uint32_t flags = in.u32();
  if (flags > (kGraphOnlyBit | kPositionsBit | kEmbeddingBit)) return "a flag is unknown";
  header.flags = unpack(flags, version == kReebVersionWithSpreads);
  if (header.flags.has_spreads && !header.flags.has_embedding) return "a file of version 2 has no embedding";
  in.u64();
  header.function_min = in.f64();
  header.function_max = in.f64();
  header.mesh_vertices = in.u64();
  header.mesh_triangles = in.u64();
  header.nodes = in.u64();
  header.arcs = in.u64();
  header.components = in.u64();
  header.loops = in.u64();
  header.records = in.u64();
  header.pairs = in.u64();
  header.kept_loops = in.u64();
  header.denoise_threshold = in.f64();
  header.denoised_pairs = in.u64();
  header.content_digest = in.u64();
  header.bucket_exponent = static_cast<std::int32_t>(in.u32());
  header.steps = in.u32();
  header.graph_frames = in.u32();
  header.pair_frames = in.u32();
  const std::uint32_t levels = in.u32();
  const std::uint32_t name_bytes = in.u32();
  if ((in.u64() | in.u64()) != 0) return "reserved bytes are not zero";
  if (name_bytes > kMaxNameBytes) return "the function's name is too long";
  header.function = in.text(name_bytes);
  if (!in.may_hold(levels, kLevelBytes)) return "the level table does not fit the header";
  header.levels.clear();
  header.levels.reserve(levels);
  for (std::uint32_t i = 0; i < levels; ++i) header.levels.push_back(decode_level(in, header.flags));
  if (!in.done() || header.region_bytes() != region_bytes) return "the header's size is wrong";
  return check_header(header);
}

void encode_frame_header(const FrameHeader& header, std::vector<std::byte>& bytes) {
  ByteWriter out(bytes);
  out.u32(static_cast<std::uint32_t>(header.kind));
  out.u32(header.stored_bytes);
  out.u32(header.raw_bytes);
  out.u32(header.nodes);
  out.u32(header.records);
  out.u32(header.versions);
  out.u32(header.finest);
  out.u32(header.reserved);
}

const char* decode_frame_header(std::span<const std::byte> bytes, FrameHeader& header) {
  ByteReader in(bytes);
  const std::uint32_t kind = in.u32();
  header.kind = static_cast<FrameKind>(kind);
  header.stored_bytes = in.u32();
  header.raw_bytes = in.u32();
  header.nodes = in.u32();
  header.records = in.u32();
  header.versions = in.u32();
  header.finest = in.u32();
  header.reserved = in.u32();
  if (!in.ok()) return "the file ends within a frame";
  if (kind != 1 && kind != 2) return "a frame is of unknown kind";
  if (header.reserved != 0) return "reserved bytes of a frame are not zero";
  if (header.raw_bytes > kMaxFrameBytes || header.stored_bytes > header.raw_bytes)
    return "a frame's size is out of range";
  return nullptr;
}

double level_threshold(std::uint32_t version, double persistence) noexcept {
  return version == 0 ? 0.0 : std::nextafter(persistence, std::numeric_limits<double>::infinity());
}

std::uint64_t level_memory(std::uint64_t nodes, std::uint64_t arcs, std::uint64_t buckets) noexcept {
  return nodes * kNodeMemoryBytes + arcs * kArcMemoryBytes + buckets * kBucketMemoryBytes;
}

}  // namespace reeb
