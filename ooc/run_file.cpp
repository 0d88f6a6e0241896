#include "ooc/run_file.h"

#include "libreeb/base/error.h"
#include "ooc/checksum.h"

namespace reeb::ooc {

namespace {

struct BlockHeader {
  std::uint32_t packed_bytes;
  std::uint32_t records;
  std::uint64_t checksum;  // XXH64 of the packed bytes, seeded with the number of records
};

}  // namespace

void RunFile::append(std::span<const std::byte> packed, std::size_t records) {
  const BlockHeader header{static_cast<std::uint32_t>(packed.size()),
                           static_cast<std::uint32_t>(records), xxh64(packed, records)};
  file_.write_at(size_, std::as_bytes(std::span(&header, 1)));
  file_.write_at(size_ + sizeof(header), packed);
  size_ += sizeof(header) + packed.size();
}

std::size_t RunFile::read(RunPlace& run, std::vector<std::byte>& packed) const {
  BlockHeader header;
  file_.read_at(run.offset, std::as_writable_bytes(std::span(&header, 1)));
  if (header.packed_bytes > size_ - run.offset) refuse(run.offset);
  packed.resize(header.packed_bytes);
  file_.read_at(run.offset + sizeof(header), packed);
  if (xxh64(packed, header.records) != header.checksum) refuse(run.offset);
  run.offset += sizeof(header) + packed.size();
  --run.blocks;
  return header.records;
}

void RunFile::refuse(std::uint64_t offset) const {
  throw Error(ErrorKind::kResource, "the disk gave back other bytes than were written",
              "check the disk, or choose another with --temp-dir DIR")
      .at(file_.path(), std::to_string(offset));
}

}  // namespace reeb::ooc
