// The frames of a `.reeb` file: header and seek table, and frames that are checked when they are read.
#pragma once

#include <cstddef>
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

namespace reeb::ooc {

// THROWS, from all members: Error{kBadInput} with path and byte offset.
// THREADS: any number may call const members at the same time, each with its own buffers.
class FrameFile {
 public:
  explicit FrameFile(const std::string& path);

  const FileHeader& header() const { return header_; }
  const std::string& path() const { return file_.path(); }
  std::uint64_t file_bytes() const { return file_.size(); }
  void read_all(std::span<std::byte> bytes) const { file_.read_at(0, bytes); }
  // THROWS: Error{kBadInput} if the file has no such version.
  void require_version(std::uint32_t version) const;

  // Null for a whole file; else what is wrong after the header, and where.
  const Error* damage() const { return damage_ ? &*damage_ : nullptr; }

  // Reads and checks frame `index` (graph frames first, then pairs). The payload is valid until the next call with the
  // same buffers.
  struct Buffers {
    std::vector<std::byte> stored, raw;
  };
  std::span<const std::byte> read_frame(std::size_t index, FrameHeader& header, Buffers& buffers) const;
  // The byte offset of frame `index`. THROWS if the file was cut off before the frame's end.
  std::uint64_t frame_offset(std::size_t index) const;
  // The byte offset after the first `frames` frames. REQUIRES: they are whole.
  std::uint64_t end_of(std::size_t frames) const { return offsets_[frames]; }

  [[noreturn]] void fail(std::uint64_t offset, const std::string& what) const;

 private:
  void read_header();
  void read_seek_table();
  void scan_frames();

  io::File file_;
  FileHeader header_;
  std::vector<std::uint64_t> offsets_;  // of the whole frames, and the end of the last
  std::optional<Error> damage_;
};

// Reads graph frames one after the other, and checks the rules that span frames. Copyable: a copy is a bookmark from
// which reading can continue.
class FrameCursor {
 public:
  explicit FrameCursor(const FrameFile& file) : complete_(file.header().steps + 1) {}

  // Replaces `frame` by the next one. THROWS: Error{kBadInput}, also after the last graph frame.
  void next(const FrameFile& file, GraphFrame& frame, FrameFile::Buffers& buffers);

  std::size_t frames_read() const { return frames_; }
  std::uint64_t nodes_read() const { return nodes_; }          // introduced so far
  std::uint32_t finest_complete() const { return complete_; }  // steps + 1: none
  bool covers(std::uint32_t version) const { return complete_ <= version; }

 private:
  void check(const FrameFile& file, const FrameHeader& header, const GraphFrame& frame);

  std::size_t frames_ = 0;
  std::uint64_t nodes_ = 0;
  std::uint32_t complete_;
  std::uint32_t last_died_ = kNeverDies;
  double last_persistence_ = std::numeric_limits<double>::infinity();
};

// That each record of the frame that was read last goes up. `key_of` gives the key of a node by its number in the file.
template <class KeyOf>
void require_rising(const FrameFile& file, const FrameCursor& cursor, const GraphFrame& frame, const KeyOf& key_of) {
  for (const FileArc& arc : frame.arcs)
    if (!(key_of(arc.lo) < key_of(arc.hi)))
      file.fail(file.frame_offset(cursor.frames_read() - 1), "an arc does not go up");
}

// That a version has as many nodes and arcs as the frame says that was read last.
void require_counts(const FrameFile& file, const FrameCursor& cursor, std::uint32_t version, const VersionCounts& said,
                    std::uint64_t nodes, std::uint64_t arcs);

}  // namespace reeb::ooc
