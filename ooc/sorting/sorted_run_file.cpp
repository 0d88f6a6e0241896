#include "ooc/sorting/sorted_run_file.h"

#include "io/file/checksum.h"
#include "libreeb/base/error.h"
#include "libreeb/base/state_stream.h"

namespace reeb::ooc {

namespace {

struct BlockHeader {
  std::uint32_t packed_bytes;
  std::uint32_t records;
  std::uint64_t checksum;  // XXH64 of the packed bytes, seeded with the number of records
};

void add_block(RunManifest& manifest, const BlockHeader& header) {
  manifest.bytes += sizeof(header) + header.packed_bytes;
  manifest.records += header.records;
  manifest.digest = io::checksum(std::as_bytes(std::span(&header, 1)), manifest.digest);
}

}  // namespace

SortedRunFile::SortedRunFile(io::File file, const RunManifest& manifest) : file_(std::move(file)) {
  if (file_.size() < manifest.bytes) throw DamagedState();
  std::vector<std::byte> packed;
  while (manifest_.bytes + sizeof(BlockHeader) <= manifest.bytes) {
    BlockHeader header;
    file_.read_at(manifest_.bytes, std::as_writable_bytes(std::span(&header, 1)));
    const std::uint64_t offset = manifest_.bytes + sizeof(header);
    if (header.packed_bytes > manifest.bytes - offset) throw DamagedState();
    packed.resize(header.packed_bytes);
    file_.read_at(offset, packed);
    if (io::checksum(packed, header.records) != header.checksum) throw DamagedState();
    add_block(manifest_, header);
  }
  if (manifest_ != manifest) throw DamagedState();
}

bool SortedRunFile::consists_of(std::span<const RunPlace> runs) const {
  std::uint64_t offset = 0;
  for (const RunPlace& run : runs) {
    if (run.offset != offset || run.blocks == 0) return false;
    for (std::uint64_t b = 0; b < run.blocks; ++b) {
      if (offset + sizeof(BlockHeader) > size()) return false;
      BlockHeader header;
      file_.read_at(offset, std::as_writable_bytes(std::span(&header, 1)));
      offset += sizeof(header) + header.packed_bytes;
    }
  }
  return offset == size();
}

void SortedRunFile::append(std::span<const std::byte> packed, std::size_t records) {
  const BlockHeader header{static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(records),
                           io::checksum(packed, records)};
  file_.write_at(size(), std::as_bytes(std::span(&header, 1)));
  file_.write_at(size() + sizeof(header), packed);
  add_block(manifest_, header);
}

std::size_t SortedRunFile::read(RunPlace& run, std::vector<std::byte>& packed) const {
  BlockHeader header;
  file_.read_at(run.offset, std::as_writable_bytes(std::span(&header, 1)));
  if (header.packed_bytes > size() - run.offset) refuse(run.offset);
  packed.resize(header.packed_bytes);
  file_.read_at(run.offset + sizeof(header), packed);
  if (io::checksum(packed, header.records) != header.checksum) refuse(run.offset);
  run.offset += sizeof(header) + packed.size();
  --run.blocks;
  return header.records;
}

void SortedRunFile::refuse(std::uint64_t offset) const {
  throw Error(ErrorKind::kResource, "the disk returned other bytes than were written",
              std::string("check the disk, or ") + io::kOtherTempFolderHint)
      .at(file_.path(), std::to_string(offset));
}

}  // namespace reeb::ooc
