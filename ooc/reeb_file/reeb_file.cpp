#include "ooc/reeb_file/reeb_file.h"

#include <array>
#include <cstring>
#include <optional>
#include <ranges>

#include "io/file/file.h"
#include "libreeb/base/count_text.h"
#include "ooc/reeb_file/frame_file.h"

namespace reeb::ooc {
namespace {

// The first version, from coarse to fine, for which `reached` holds. `reached` of the lines of the level table
// determines which frames to search.
template <class Reached>
std::optional<std::uint32_t> first_version(const FrameFile& file, const Reached& reached) {
  const LevelLine* before = nullptr;
  const LevelLine* line = nullptr;
  for (const LevelLine& level : file.header().levels) {
    line = &level;
    if (reached(level.version, level.threshold, level.nodes, level_memory(level.nodes, level.arcs, level.buckets)))
      break;
    before = line;
  }
  if (before == line) return std::nullopt;
  GraphFrame frame;
  FrameFile::Buffers buffers;
  for (std::size_t i = before == nullptr ? 0 : before->frames - 1; i < line->frames; ++i) {
    FrameHeader header;
    const auto payload = file.read_frame(i, header, buffers);
    if (const char* why = decode_graph_frame(payload, header, file.header().flags, frame))
      file.fail(file.frame_offset(i), why);
    for (std::size_t k = 0; k < frame.versions.size(); ++k) {
      const VersionCounts& counts = frame.versions[k];
      const auto version = static_cast<std::uint32_t>(header.finest + frame.versions.size() - 1 - k);
      if (reached(version, level_threshold(version, counts.persistence), counts.nodes,
                  level_memory(counts.nodes, counts.arcs, counts.buckets)))
        return version;
    }
  }
  file.fail(file.frame_offset(line->frames - 1), "the level table does not fit the frames");
}

template <class Measure>
std::uint32_t finest_within(const FrameFile& file, std::uint64_t limit, const Measure& measure, const char* unit) {
  const auto too_large = first_version(file, [&](std::uint32_t, double, std::uint64_t nodes, std::uint64_t bytes) {
    return measure(nodes, bytes) > limit;
  });
  if (!too_large) return 0;
  if (*too_large < file.header().steps) return *too_large + 1;
  const LevelLine& coarsest = file.header().levels.front();
  throw Error(ErrorKind::kBadInput,
              "even the coarsest level is larger: it has " + count_of(coarsest.nodes, "node") + " and takes " +
                  count_of(coarsest.memory_bytes, "byte"),
              "allow at least " + std::to_string(measure(coarsest.nodes, coarsest.memory_bytes)) + " " + unit)
      .at(file.path());
}

bool is_whole(const FrameFile& file, std::size_t frame) {
  try {
    FrameHeader header;
    FrameFile::Buffers buffers;
    (void)file.read_frame(frame, header, buffers);
    return true;
  } catch (const Error&) {
    return false;
  }
}

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

ReebFile::ReebFile(const std::string& path) : frames_(std::make_unique<FrameFile>(path)) {}
ReebFile::ReebFile(ReebFile&&) noexcept = default;
ReebFile& ReebFile::operator=(ReebFile&&) noexcept = default;
ReebFile::~ReebFile() = default;

const FileHeader& ReebFile::header() const { return frames_->header(); }
const std::string& ReebFile::path() const { return frames_->path(); }
std::uint64_t ReebFile::file_bytes() const { return frames_->file_bytes(); }
void ReebFile::read_all(std::span<std::byte> bytes) const { frames_->read_all(bytes); }
const Error* ReebFile::damage() const { return frames_->damage(); }

void ReebFile::require_hierarchy(const char* what) const {
  if (!header().flags.graph_only) return;
  throw Error(ErrorKind::kBadInput, std::string("the file has the graph only, no ") + what,
              "compute it again without --graph-only")
      .at(path());
}

std::uint32_t ReebFile::version_at(double threshold) const {
  if (threshold > 0) require_hierarchy("levels");
  if (!(threshold >= 0))
    throw Error(ErrorKind::kUsage, "a threshold is not a number from 0 on", "give a threshold like 0.01 or 0.1%");
  const auto found = first_version(
      *frames_, [&](std::uint32_t, double least, std::uint64_t, std::uint64_t) { return least <= threshold; });
  return found.value_or(0);
}

std::uint32_t ReebFile::finest_with_nodes(std::uint64_t limit) const {
  require_hierarchy("levels");
  try {
    return finest_within(
        *frames_, limit, [](std::uint64_t nodes, std::uint64_t) { return nodes; }, "nodes");
  } catch (const Error& error) {
    if (error.cause() == ErrorCause::kUnreadable) throw;
    // Finer versions with as many nodes may be in a part that is missing or damaged.
    for (const LevelLine& level : header().levels | std::views::reverse)
      if (level.nodes == limit && is_whole(*frames_, level.frames - 1)) return level.version;
    throw;
  }
}

std::uint32_t ReebFile::finest_with_memory(std::uint64_t limit) const {
  require_hierarchy("levels");
  return finest_within(
      *frames_, limit, [](std::uint64_t, std::uint64_t bytes) { return bytes; }, "bytes");
}

}  // namespace reeb::ooc
