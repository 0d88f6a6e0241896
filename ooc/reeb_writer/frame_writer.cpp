#include "ooc/reeb_writer/frame_writer.h"

#include "libreeb/base/byte_coding.h"

namespace reeb::ooc {
namespace {

// Finds repetitions only. Level 1 also makes Huffman codes: frames are 3.5 % smaller, and compressing takes twice as
// long.
constexpr int kZstdLevel = -1;
// Smaller frames are stored uncompressed: compression gains nothing, and a person can read small files.
constexpr std::size_t kCompressFromBytes = 512;
// Most frames are larger than this, and bypass the buffer.
constexpr std::size_t kBufferBytes = 64 << 10;

}  // namespace

void PackedFrame::pack(FrameHeader header) {
  packed_.clear();
  if (payload.size() >= kCompressFromBytes) compressor_.compress(payload, kZstdLevel, packed_);
  const bool pays = !packed_.empty() && packed_.size() < payload.size();
  const std::vector<std::byte>& content = pays ? packed_ : payload;
  header.raw_bytes = static_cast<std::uint32_t>(payload.size());
  header.stored_bytes = static_cast<std::uint32_t>(content.size());

  stored_.clear();
  encode_frame_header(header, stored_);
  io::RunningChecksum sum;
  sum.add(stored_);
  sum.add(content);
  ByteWriter out(stored_);
  out.u64(sum.value());
  out.bytes(content);
}

FrameWriter::FrameWriter(const std::string& path, std::uint64_t region_bytes, const OutputOptions& options)
    : output_(path, {.existing = options.existing,
                     .overwrites = true,
                     .temp_folder = options.temp_folder,
                     .buffer_bytes = kBufferBytes}),
      file_(output_.out()) {
  file_.append(std::vector<std::byte>(region_bytes));
}

void FrameWriter::add(const PackedFrame& frame) {
  digest_.add(frame.payload);
  offsets_.push_back(file_.size());
  file_.append(frame.stored());
}

void FrameWriter::finish(FileHeader& header) {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  const std::uint64_t table_offset = file_.size();
  for (const std::uint64_t offset : offsets_) out.u64(offset);
  out.u64(table_offset);
  out.u64(io::checksum(bytes));
  for (const std::uint8_t byte : kReebEndMagic) out.u8(byte);
  file_.append(bytes);

  header.content_digest = digest_.value();
  bytes.clear();
  encode_header(header, bytes);
  out.u64(io::checksum(bytes));
  file_.overwrite(0, bytes);
  output_.commit();
}

}  // namespace reeb::ooc
