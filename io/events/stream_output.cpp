#include "io/events/stream_output.h"

#include "libreeb/base/error.h"

namespace reeb::io {

void StreamOutput::flush() {
  out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
  text_.clear();
}

void StreamOutput::finish() {
  flush();
  out_.flush();
  if (!out_) throw Error(ErrorKind::kResource, "cannot write the mesh", "is the disk full, or the place read-only?");
}

void require_cell_kind(EventKind kind, bool volume) {
  if (kind == EventKind::kTriangle && volume)
    fail_format("a volume mesh cannot hold triangles", "write SMA, SMB or SMC instead");
  if (kind == EventKind::kTetrahedron && !volume)
    fail_format("this format cannot hold tetrahedra", "write SVA or SVB instead");
}

void fail_format(const std::string& what, const std::string& hint) { throw Error(ErrorKind::kBadInput, what, hint); }

}  // namespace reeb::io
