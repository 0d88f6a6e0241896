#include "io/mesh/batch_reader.h"

#include "libreeb/base/error.h"

namespace reeb::io {

void refuse_properties(const ReadOptions& options, const std::string& format, const std::string& file) {
  if (options.properties.empty()) return;
  throw Error(ErrorKind::kBadInput, "the mesh has no vertex property \"" + options.properties.front() + "\"",
              format + " files have no named vertex properties; use a coordinate, or file:PATH")
      .at(file);
}

}  // namespace reeb::io
