// The part of a `.reeb` file that all its writers share: frames one after the other, then the seek table and the tail.
// The header region in front is written once everything in it is known.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/zstd_codec.h"
#include "libreeb/format/reeb_format.h"

namespace reeb::ooc {

// How the file gets its name.
struct OutputOptions {
  io::Existing existing = io::Existing::kReplace;
  std::string temp_folder = {};  // for a device, whose bytes are collected first; empty: as AtomicFile
};

// A frame as it is stored. One object is used for one frame after the other, so that its memory is reused.
//
// MEMORY: the payload, the stored bytes twice, and a compressor.
class PackedFrame {
 public:
  std::vector<std::byte> payload;  // to be filled before pack()

  // Packs the payload. The sizes in `header` are filled in here.
  void pack(FrameHeader header);
  // REQUIRES: pack() was called since the payload has changed.
  std::span<const std::byte> stored() const { return stored_; }

 private:
  io::ZstdCompressor compressor_;
  std::vector<std::byte> stored_, packed_;
};

// THROWS: as AtomicFile, from every call.
class FrameWriter {
 public:
  // Leaves room for a header region of this size.
  FrameWriter(const std::string& path, std::uint64_t region_bytes, const OutputOptions& options);

  // Appends a frame that was packed.
  void add(const PackedFrame& frame);

  std::uint64_t size() const { return file_.size(); }

  // Writes seek table, tail and header (whose digest is filled in here), and commits the file.
  // REQUIRES: header.region_bytes() has not changed since the constructor.
  void finish(FileHeader& header);

 private:
  io::AtomicFile output_;
  io::BufferedWriter& file_;
  io::RunningChecksum digest_;
  std::vector<std::uint64_t> offsets_;  // of the frames
};

}  // namespace reeb::ooc
