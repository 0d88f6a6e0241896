#include "io/events/format_limits.h"

#include "libreeb/base/error.h"

namespace reeb::io {

void require_cell_kind(EventKind kind, bool volume) {
  if (kind == EventKind::kTriangle && volume)
    fail_format("a volume mesh cannot hold triangles", "write SMA, SMB or CX instead");
  if (kind == EventKind::kTetrahedron && !volume)
    fail_format("this format cannot hold tetrahedra", "write SVA or SVB instead");
}

void fail_format(const std::string& what, const std::string& hint) { throw Error(ErrorKind::kBadInput, what, hint); }

}  // namespace reeb::io
