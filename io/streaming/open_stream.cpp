#include "io/streaming/open_stream.h"

#include "io/events/stream_fault.h"
#include "io/file/file_name.h"
#include "io/smc/smc_reader.h"
#include "io/streaming/block_reader.h"
#include "io/streaming/text_reader.h"
#include "io/text/cursor.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

bool is_text(unsigned byte) { return byte == '\t' || byte == '\n' || byte == '\r' || (byte >= 0x20 && byte < 0x7F); }

std::string hexadecimal(unsigned byte) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  return {'0', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

[[noreturn]] void refuse(const std::string& what) {
  fail(Fault::kUnsupported, "this is " + what + "; only SMA, SMB, SMC (versions 1 and 3), SVA and SVB are read", "0");
}

std::unique_ptr<EventReader> open_any(Cursor cursor, const std::string& path) {
  if (cursor.at_end()) fail(Fault::kTruncated, "the file is empty", "0");
  const bool has_second = cursor.ensure(2);
  const unsigned first = static_cast<unsigned char>(cursor.data()[0]);
  const unsigned second = has_second ? static_cast<unsigned char>(cursor.data()[1]) : 0;

  if (content_suffix(path) == ".svc") refuse("a compressed volume mesh (SVC)");
  if (first == 0x1F && second == 0x8B) refuse("gzip-compressed");
  if (is_text(first)) return std::make_unique<TextEventReader>(std::move(cursor), content_suffix(path) == ".sva");
  switch (first) {
    case 0:
      return std::make_unique<SmbEventReader>(std::move(cursor));
    case 1:
      if (has_second && second != 1) refuse("an old SMC (2003) file");
      return std::make_unique<SmcEventReader>(std::move(cursor));
    case 2:
      refuse("an SMD file");
    case 3:
      return std::make_unique<SmcEventReader>(std::move(cursor));
    case 4:
      return std::make_unique<SvbEventReader>(std::move(cursor));
    default:
      refuse("no streaming mesh (first byte " + hexadecimal(first) + ")");
  }
}

}  // namespace

bool looks_like_binary_stream(char first) { return static_cast<unsigned char>(first) <= 4; }

std::unique_ptr<EventReader> open_stream(std::unique_ptr<ContentSource> source, const std::string& path) {
  const std::string name = source->name();
  try {
    auto reader = open_any(Cursor(std::move(source)), path);
    reader->set_name(name);
    return reader;
  } catch (Error& error) {
    error.at(name);
    throw;
  }
}

}  // namespace reeb::io
