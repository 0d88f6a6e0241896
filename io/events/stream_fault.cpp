#include "io/events/stream_fault.h"

#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

struct FaultText {
  const char* name;
  const char* hint;
};

FaultText text_of(Fault fault) {
  switch (fault) {
    case Fault::kTruncated:
      return {"TRUNCATED", "the file seems to be cut off; fetch or write it again"};
    case Fault::kBadHeader:
      return {"BAD_HEADER", "the head of the file is damaged; write the file again"};
    case Fault::kBadNumber:
      return {"BAD_NUMBER", "fix this element in the file, or write the file again"};
    case Fault::kBadIndex:
      return {"BAD_INDEX", "a cell may only name vertices that the stream has"};
    case Fault::kFinalIndex:
      return {"FINAL_INDEX", "the finalization in this file is wrong; write it again from its source"};
    case Fault::kMissingVertex:
      return {"MISSING_VERTEX", "the file lacks vertices; write it again from its source"};
    case Fault::kNotTriangle:
      return {"NOT_TRIANGLE", "if this is an OBJ file, give it as one; else split polygons first"};
    case Fault::kUnsupported:
      return {"UNSUPPORTED", "convert the file to SMA, SMB or SMC version 3 first"};
    case Fault::kCorrupt:
      return {"CORRUPT", "the compressed data are damaged; fetch or write the file again"};
  }
  return {"CORRUPT", ""};
}

}  // namespace

void fail(Fault fault, const std::string& what, const std::string& position) {
  const FaultText text = text_of(fault);
  Error error(ErrorKind::kBadInput, std::string(text.name) + ": " + what, text.hint);
  error.at({}, position);
  throw error;
}

std::string count_warning(const Tally& tally, const char* what, bool fewer_too) {
  if (!tally.promised || tally.delivered == *tally.promised) return {};
  if (tally.delivered < *tally.promised && !fewer_too) return {};
  return "COUNT: the header announces " + std::to_string(*tally.promised) + " " + what + ", the stream holds " +
         std::to_string(tally.delivered);
}

void require_promised(const Tally& tally, const char* what, const std::string& position) {
  if (!tally.promised || tally.delivered >= *tally.promised) return;
  fail(Fault::kTruncated,
       "file ends after " + std::to_string(tally.delivered) + " of " + std::to_string(*tally.promised) + " " + what,
       position);
}

}  // namespace reeb::io
