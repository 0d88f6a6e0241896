#include "ooc/reeb_file/reeb_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "io/file/checksum.h"
#include "io/file/zstd_codec.h"
#include "libreeb/base/byte_coding.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {
namespace {

constexpr const char* kMakeAgain = "the file is damaged; compute it again";

std::uint64_t last_u64(std::span<const std::byte> bytes) { return ByteReader(bytes.last(8)).u64(); }

// The frames that a whole header region announces.
std::size_t frame_count(const FileHeader& header) { return std::size_t{header.graph_frames} + header.pair_frames; }

}  // namespace

bool is_reeb_file(std::span<const std::byte> bytes) {
  return bytes.size() >= kReebMagic.size() && std::memcmp(bytes.data(), kReebMagic.data(), kReebMagic.size()) == 0;
}

bool is_reeb_file(const std::string& path) {
  try {
    const io::File file = io::File::open_for_reading(path);
    std::array<std::byte, kReebMagic.size()> start{};
    if (file.size() < start.size()) return false;
    file.read_at(0, start);
    return is_reeb_file(start);
  } catch (const Error&) {
    return false;
  }
}

ReebFile::ReebFile(const std::string& path) : file_(io::File::open_for_reading(path)) {
  read_header();
  try {
    read_seek_table();
  } catch (const Error& error) {
    damage_ = error;
    scan_frames();
  }
}

void ReebFile::read_header() {
  std::vector<std::byte> region(std::min<std::uint64_t>(file_.size(), kFixedHeaderBytes));
  file_.read_at(0, region);
  std::uint64_t region_bytes = 0;
  if (const char* why = decode_region_bytes(region, region_bytes)) fail(0, why);
  if (region_bytes > file_.size()) fail(file_.size(), "the file ends within its header");
  region.resize(region_bytes);
  file_.read_at(0, region);
  const auto content = std::span(region).first(region_bytes - kChecksumBytes);
  if (io::checksum(content) != last_u64(region)) fail(region_bytes - kChecksumBytes, "the header's checksum is wrong");
  if (const char* why = decode_header(content, header_)) fail(0, why);
  // Each frame has a header and an entry in the seek table.
  if (frame_count(header_) == 0) fail(0, "the header announces no frames");
}

void ReebFile::read_seek_table() {
  const std::uint64_t table_bytes = 8 * std::uint64_t{frame_count(header_)};
  const std::uint64_t region = header_.region_bytes();
  if (file_.size() < region || file_.size() - region < table_bytes + kTailBytes)
    fail(file_.size(), "the file ends before its end mark");
  const std::uint64_t table_offset = file_.size() - kTailBytes - table_bytes;
  std::vector<std::byte> bytes(table_bytes + kTailBytes);
  file_.read_at(table_offset, bytes);
  if (std::memcmp(bytes.data() + bytes.size() - kReebEndMagic.size(), kReebEndMagic.data(), kReebEndMagic.size()) != 0)
    fail(file_.size() - kReebEndMagic.size(), "the end mark is missing");
  const auto covered = std::span(bytes).first(table_bytes + 8);
  ByteReader in(bytes);
  offsets_.clear();
  for (std::size_t i = 0; i < frame_count(header_); ++i) offsets_.push_back(in.u64());
  offsets_.push_back(in.u64());
  if (in.u64() != io::checksum(covered)) fail(table_offset, "the seek table's checksum is wrong");
  if (offsets_.front() != region || offsets_.back() != table_offset || !std::ranges::is_sorted(offsets_))
    fail(table_offset, "the seek table does not fit the file");
}

// Without a seek table: from frame to frame, as far as they are whole.
void ReebFile::scan_frames() {
  offsets_.assign(1, header_.region_bytes());
  FrameBuffers buffers;
  for (std::size_t i = 0; i < frame_count(header_); ++i) {
    FrameHeader frame;
    offsets_.push_back(file_.size());  // as far as the frame can reach
    try {
      read_frame(i, frame, buffers);
    } catch (const Error& error) {
      offsets_.pop_back();
      damage_ = error;
      return;
    }
    offsets_.back() = offsets_[i] + kFrameHeaderBytes + frame.stored_bytes;
  }
}

std::uint64_t ReebFile::frame_offset(std::size_t index) const {
  if (index + 1 < offsets_.size()) return offsets_[index];
  Error error(
      ErrorKind::kBadInput,
      "this part of the file is missing or damaged: " + (damage_ ? damage_->message() : std::string("no such frame")) +
          "; only " + std::to_string(offsets_.size() - 1) + " of " + std::to_string(frame_count(header_)) +
          " frames are whole",
      "ask for a coarser level, or compute the file again");
  throw error.at(path(), std::to_string(offsets_.back()));
}

std::span<const std::byte> ReebFile::read_frame(std::size_t index, FrameHeader& header, FrameBuffers& buffers) const {
  const std::uint64_t offset = frame_offset(index);
  const std::uint64_t limit = offsets_[index + 1] - offset;
  if (limit < kFrameHeaderBytes) fail(offset, "the file ends within a frame");
  buffers.stored.resize(kFrameHeaderBytes);
  file_.read_at(offset, buffers.stored);
  if (const char* why = decode_frame_header(buffers.stored, header)) fail(offset, why);
  if (header.stored_bytes > limit - kFrameHeaderBytes) fail(offset, "the file ends within a frame");
  const std::uint64_t sum = last_u64(buffers.stored);
  // The payload takes the place of the checksum, so that what is covered lies in one piece.
  const std::size_t covered = kFrameHeaderBytes - kChecksumBytes;
  buffers.stored.resize(covered + header.stored_bytes);
  file_.read_at(offset + kFrameHeaderBytes, std::span(buffers.stored).subspan(covered));
  if (io::checksum(buffers.stored) != sum) fail(offset, "a frame's checksum is wrong");
  const bool graph = index < header_.graph_frames;
  if (header.kind != (graph ? FrameKind::kGraph : FrameKind::kPairs)) fail(offset, "a frame is of the wrong kind");
  const auto payload = std::span<const std::byte>(buffers.stored).subspan(covered);
  if (header.stored_bytes == header.raw_bytes) return payload;
  buffers.raw.resize(header.raw_bytes);
  if (!io::zstd_decompress(payload, buffers.raw)) fail(offset, "a frame cannot be decompressed");
  return buffers.raw;
}

void ReebFile::fail(std::uint64_t offset, const std::string& what) const {
  throw Error(ErrorKind::kBadInput, what, kMakeAgain).at(file_.path(), std::to_string(offset));
}

void ReebFile::require_hierarchy(const char* what) const {
  if (!header_.flags.graph_only) return;
  throw Error(ErrorKind::kBadInput, std::string("the file has the graph only, no ") + what,
              "compute it again without --graph-only")
      .at(path());
}

// The first version, from coarse to fine, for which `reached` holds; `reached` of a line of the
// level table tells which frames to look into.
template <class Reached>
std::optional<std::uint32_t> ReebFile::first_version(const Reached& reached) const {
  const LevelLine* before = nullptr;
  const LevelLine* line = nullptr;
  for (const LevelLine& level : header_.levels) {
    line = &level;
    if (reached(level.version, level.threshold, level.nodes, level_memory(level.nodes, level.arcs, level.buckets)))
      break;
    before = line;
  }
  if (before == line) return std::nullopt;
  GraphFrame frame;
  FrameBuffers buffers;
  for (std::size_t i = before == nullptr ? 0 : before->frames - 1; i < line->frames; ++i) {
    FrameHeader header;
    const auto payload = read_frame(i, header, buffers);
    if (const char* why = decode_graph_frame(payload, header, header_.flags, frame)) fail(frame_offset(i), why);
    for (std::size_t k = 0; k < frame.versions.size(); ++k) {
      const VersionCounts& counts = frame.versions[k];
      const auto version = static_cast<std::uint32_t>(header.finest + frame.versions.size() - 1 - k);
      if (reached(version, level_threshold(version, counts.persistence), counts.nodes,
                  level_memory(counts.nodes, counts.arcs, counts.buckets)))
        return version;
    }
  }
  fail(frame_offset(line->frames - 1), "the level table does not fit the frames");
}

std::uint32_t ReebFile::version_at(double threshold) const {
  if (threshold > 0) require_hierarchy("levels");
  if (!(threshold >= 0))
    throw Error(ErrorKind::kUsage, "a threshold is not a number from 0 on", "give a threshold like 0.01 or 0.1%");
  const auto found =
      first_version([&](std::uint32_t, double least, std::uint64_t, std::uint64_t) { return least <= threshold; });
  return found.value_or(0);
}

template <class Measure>
std::uint32_t ReebFile::finest_within(std::uint64_t limit, const Measure& measure, const char* unit) const {
  require_hierarchy("levels");
  const auto too_large = first_version(
      [&](std::uint32_t, double, std::uint64_t nodes, std::uint64_t bytes) { return measure(nodes, bytes) > limit; });
  if (!too_large) return 0;
  if (*too_large < header_.steps) return *too_large + 1;
  const LevelLine& coarsest = header_.levels.front();
  throw Error(ErrorKind::kBadInput,
              "even the coarsest level is larger: it has " + std::to_string(coarsest.nodes) + " nodes and takes " +
                  std::to_string(coarsest.memory_bytes) + " bytes",
              "allow at least " + std::to_string(measure(coarsest.nodes, coarsest.memory_bytes)) + " " + unit)
      .at(path());
}

std::uint32_t ReebFile::finest_with_nodes(std::uint64_t limit) const {
  return finest_within(
      limit, [](std::uint64_t nodes, std::uint64_t) { return nodes; }, "nodes");
}

std::uint32_t ReebFile::finest_with_memory(std::uint64_t limit) const {
  return finest_within(
      limit, [](std::uint64_t, std::uint64_t bytes) { return bytes; }, "bytes");
}

void FrameCursor::next(const ReebFile& file, GraphFrame& frame, ReebFile::FrameBuffers& buffers) {
  FrameHeader header;
  const std::uint64_t offset = file.frame_offset(frames_);
  if (frames_ >= file.header().graph_frames) file.fail(offset, "the graph frames end before the full graph");
  const auto payload = file.read_frame(frames_, header, buffers);
  if (const char* why = decode_graph_frame(payload, header, file.header().flags, frame)) file.fail(offset, why);
  check(file, header, frame);
  ++frames_;
}

void FrameCursor::check(const ReebFile& file, const FrameHeader& header, const GraphFrame& frame) {
  const std::uint64_t offset = file.frame_offset(frames_);
  const std::uint32_t steps = file.header().steps;
  if (std::uint64_t{header.finest} + header.versions != complete_)
    file.fail(offset, "the versions of a frame do not follow those before");
  nodes_ += frame.nodes.size();
  if (nodes_ > std::numeric_limits<std::uint32_t>::max()) file.fail(offset, "there are more nodes than can be loaded");
  for (const FileArc& arc : frame.arcs) {
    if (arc.lo >= nodes_ || arc.hi >= nodes_ || arc.lo == arc.hi)
      file.fail(offset, "an arc ends at a node that was not introduced");
    if (arc.died != kNeverDies && arc.died > steps) file.fail(offset, "an arc dies after the last version");
    if (arc.died > last_died_ || arc.born > steps) file.fail(offset, "the arcs are not sorted by their end");
    // Versions announced as complete get no further arcs.
    if (arc.died > complete_ && complete_ <= steps)
      file.fail(offset, "an arc comes after the versions that it belongs to");
    last_died_ = arc.died;
  }
  complete_ = header.finest;
  for (const VersionCounts& counts : frame.versions) {
    if (counts.persistence > last_persistence_) file.fail(offset, "the persistences are not descending");
    last_persistence_ = counts.persistence;
  }
}

}  // namespace reeb::ooc
