// Reads `.reeb` files (docs/FORMAT.md): any level in time proportional to what it yields.
//
// Nothing in the file is trusted: every byte is under a checksum that is verified before it is
// used, and nothing is reserved on the word of a count alone. A file that was cut, or is damaged
// behind its header, yields the levels that its whole frames cover.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/error.h"
#include "libreeb/format/frame_codec.h"
#include "libreeb/format/reeb_format.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/reeb_graph.h"

namespace reeb::ooc {

// Whether `bytes` begins like a `.reeb` file; eight bytes are enough.
bool is_reeb_file(std::span<const std::byte> bytes);
// The same for a file; false if it cannot be read.
bool is_reeb_file(const std::string& path);

// A graph at one version.
struct Level {
  std::uint32_t version = 0;
  double threshold = 0;  // the least that yields it
  ReebGraph graph;
  ArcBuckets buckets;  // of graph's arcs; empty without an embedding
};

// A pair by its nodes.
struct PairRow {
  SettledNode lo, hi;
  PairType type = PairType::kExt0;
  bool kept = false;
};

class ReebFile {
 public:
  // Reads header, level table and seek table.
  // THROWS, as all members: Error{kBadInput} with path and byte offset.
  explicit ReebFile(const std::string& path);

  const FileHeader& header() const { return header_; }
  std::span<const LevelLine> levels() const { return header_.levels; }
  const std::string& path() const { return file_.path(); }
  std::uint64_t file_bytes() const { return file_.size(); }

  // Null for a whole file; else what is wrong behind the header, and where. Levels that need the
  // missing part are refused.
  const Error* damage() const { return damage_ ? &*damage_ : nullptr; }

  // The version after all cancellations of persistence below `threshold`.
  std::uint32_t version_at(double threshold) const;
  // The finest version with at most so many nodes, or so much memory as level_memory counts it.
  // THROWS: Error{kBadInput} if even the coarsest is larger, with its size.
  std::uint32_t finest_with_nodes(std::uint64_t nodes) const;
  std::uint32_t finest_with_memory(std::uint64_t bytes) const;

  // Version 0 is the full graph. Reads the frames that it needs and no others.
  Level load(std::uint32_t version = 0) const;

  // In the order of cancelling, Ext0 last. THROWS also for a file without hierarchy.
  std::vector<PairRow> pairs() const;

  // Checks everything that can be checked: checksums and digest, order, counts of every version,
  // level table, pairs against Betti numbers; with an embedding also that every vertex of the mesh is
  // somewhere. MEMORY: about 108 bytes an arc record.
  void verify() const;

  // Reads and checks frame `index` (graph frames first, then pairs). The payload is valid until the
  // next call with the same buffers.
  struct FrameBuffers {
    std::vector<std::byte> stored, raw;
  };
  std::span<const std::byte> read_frame(std::size_t index, FrameHeader& header, FrameBuffers& buffers) const;
  // Byte offset of frame `index`. THROWS if the file was cut before its end.
  std::uint64_t frame_offset(std::size_t index) const;

  [[noreturn]] void fail(std::uint64_t offset, const std::string& what) const;

 private:
  void read_header();
  void read_seek_table();
  void scan_frames();
  void require_hierarchy(const char* what) const;
  template <class Reached>
  std::optional<std::uint32_t> first_version(const Reached& reached) const;
  template <class Measure>
  std::uint32_t finest_within(std::uint64_t limit, const Measure& measure, const char* unit) const;

  io::File file_;
  FileHeader header_;
  std::vector<std::uint64_t> offsets_;  // of the whole frames, and the end of the last
  std::optional<Error> damage_;
};

// Reads graph frames one after the other and checks what spans frames. Copyable: a copy is a
// bookmark from which reading can go on.
class FrameCursor {
 public:
  explicit FrameCursor(const ReebFile& file) : complete_(file.header().steps + 1) {}

  // Replaces `frame` by the next one. THROWS: Error{kBadInput}; at the end of all graph frames too.
  void next(const ReebFile& file, GraphFrame& frame, ReebFile::FrameBuffers& buffers);

  std::size_t frames_read() const { return frames_; }
  std::uint64_t nodes_read() const { return nodes_; }          // introduced so far
  std::uint32_t finest_complete() const { return complete_; }  // steps + 1: none
  bool covers(std::uint32_t version) const { return complete_ <= version; }

 private:
  void check(const ReebFile& file, const FrameHeader& header, const GraphFrame& frame);

  std::size_t frames_ = 0;
  std::uint64_t nodes_ = 0;
  std::uint32_t complete_;
  std::uint32_t last_died_ = kNeverDies;
  double last_persistence_ = std::numeric_limits<double>::infinity();
};

}  // namespace reeb::ooc
