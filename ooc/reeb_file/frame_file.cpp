#include "ooc/reeb_file/frame_file.h"

#include <algorithm>
#include <cstring>

#include "io/file/checksum.h"
#include "io/file/zstd_codec.h"
#include "libreeb/base/byte_coding.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::ooc {
namespace {

constexpr const char* kMakeAgain = "the file is damaged; compute it again";

std::uint64_t last_u64(std::span<const std::byte> bytes) { return ByteReader(bytes.last(8)).u64(); }

// The frames that a whole header region announces.
std::size_t frame_count(const FileHeader& header) { return std::size_t{header.graph_frames} + header.pair_frames; }

}  // namespace

FrameFile::FrameFile(const std::string& path) : file_(io::File::open_for_reading(path)) {
  read_header();
  try {
    read_seek_table();
  } catch (const Error& error) {
    damage_ = error;
    scan_frames();
  }
}

void FrameFile::require_version(std::uint32_t version) const {
  if (version <= header_.steps) return;
  throw Error(ErrorKind::kBadInput, "there is no version " + std::to_string(version),
              "the coarsest is " + std::to_string(header_.steps))
      .at(path());
}

void FrameFile::read_header() {
  std::vector<std::byte> region(std::min<std::uint64_t>(file_.size(), kFixedHeaderBytes));
  file_.read_at(0, region);
  std::uint64_t region_bytes = 0;
  if (const auto version = unknown_version(region))
    fail(8, "the format version is " + std::to_string(*version) + ", and this program reads 1 and 2");
  if (!is_reeb_file(region))
    throw Error(ErrorKind::kBadInput, "this is not a .reeb file",
                "name a .reeb file; `reeb MESH` makes one from a mesh, and so does reeb.compute in Python")
        .at(file_.path(), "0");
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

void FrameFile::read_seek_table() {
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

// Without a seek table: goes from frame to frame while they are whole.
void FrameFile::scan_frames() {
  offsets_.assign(1, header_.region_bytes());
  Buffers buffers;
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

std::uint64_t FrameFile::frame_offset(std::size_t index) const {
  if (index + 1 < offsets_.size()) return offsets_[index];
  Error error(
      ErrorKind::kBadInput,
      "this part of the file is missing or damaged: " + (damage_ ? damage_->message() : std::string("no such frame")) +
          "; only " + std::to_string(offsets_.size() - 1) + " of " + std::to_string(frame_count(header_)) +
          " frames are whole",
      "ask for a coarser level, or compute the file again");
  throw error.at(path(), std::to_string(offsets_.back()));
}

std::span<const std::byte> FrameFile::read_frame(std::size_t index, FrameHeader& header, Buffers& buffers) const {
  const std::uint64_t offset = frame_offset(index);
  const std::uint64_t limit = offsets_[index + 1] - offset;
  if (limit < kFrameHeaderBytes) fail(offset, "the file ends within a frame");
  buffers.stored.resize(kFrameHeaderBytes);
  file_.read_at(offset, buffers.stored);
  if (const char* why = decode_frame_header(buffers.stored, header)) fail(offset, why);
  if (header.stored_bytes > limit - kFrameHeaderBytes) fail(offset, "the file ends within a frame");
  const std::uint64_t sum = last_u64(buffers.stored);
  // The payload takes the place of the checksum, so that the covered bytes are contiguous.
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

void FrameFile::fail(std::uint64_t offset, const std::string& what) const {
  throw Error(ErrorKind::kBadInput, what, kMakeAgain).at(file_.path(), std::to_string(offset));
}

void FrameCursor::next(const FrameFile& file, GraphFrame& frame, FrameFile::Buffers& buffers) {
  FrameHeader header;
  const std::uint64_t offset = file.frame_offset(frames_);
  if (frames_ >= file.header().graph_frames) file.fail(offset, "the graph frames end before the full graph");
  const auto payload = file.read_frame(frames_, header, buffers);
  if (const char* why = decode_graph_frame(payload, header, file.header().flags, frame)) file.fail(offset, why);
  check(file, header, frame);
  ++frames_;
}

void FrameCursor::check(const FrameFile& file, const FrameHeader& header, const GraphFrame& frame) {
  const std::uint64_t offset = file.frame_offset(frames_);
  const std::uint32_t steps = file.header().steps;
  if (std::uint64_t{header.finest} + header.versions != complete_)
    file.fail(offset, "the versions of a frame do not follow those before");
  nodes_ += frame.nodes.size();
  if (nodes_ > std::numeric_limits<std::uint32_t>::max()) file.fail(offset, "there are more nodes than can be loaded");
  for (const FileArc& arc : frame.arcs) {
    if (arc.lo >= nodes_ || arc.hi >= nodes_) file.fail(offset, "an arc ends at a node that was not introduced");
    if (arc.died != kNeverDies && arc.died > steps) file.fail(offset, "an arc dies after the last version");
    if (arc.born > steps) file.fail(offset, "an arc begins after the last version");
    if (arc.died > last_died_) file.fail(offset, "the arcs are not sorted by their end");
    // A version announced as complete gets no further arcs.
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

void require_counts(const FrameFile& file, const FrameCursor& cursor, std::uint32_t version, const VersionCounts& said,
                    std::uint64_t nodes, std::uint64_t arcs) {
  if (nodes != said.nodes || arcs != said.arcs)
    file.fail(file.end_of(cursor.frames_read()),
              "version " + std::to_string(version) + " has other counts than the file says");
}

}  // namespace reeb::ooc
