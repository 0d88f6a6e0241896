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

// THROWS: as AtomicFile, from every call.
class FrameWriter {
 public:
  // Leaves room for a header region of this size.
  FrameWriter(const std::string& path, std::uint64_t region_bytes, const OutputOptions& options);

  // Appends a frame. The sizes in `header` are filled in here.
  void add(FrameHeader header, std::span<const std::byte> payload);

  std::uint64_t size() const { return file_.size(); }

  // Writes seek table, tail and header (whose digest is filled in here), and commits the file.
  // REQUIRES: header.region_bytes() has not changed since the constructor.
  void finish(FileHeader& header);

 private:
  io::AtomicFile output_;
  io::BufferedWriter& file_;
  io::RunningChecksum digest_;
  io::ZstdCompressor compressor_;
  std::vector<std::uint64_t> offsets_;  // of the frames
  std::vector<std::byte> frame_, packed_;
};

}  // namespace reeb::ooc
