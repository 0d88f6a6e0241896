#include "io/mesh/batch_reader.h"

#include "io/mesh/missing_property.h"

namespace reeb::io {

void refuse_properties(const ReadOptions& options, const std::string& format, const std::string& file) {
  if (options.properties.empty()) return;
  throw missing_property(options.properties.front(), {})
      .with_hint(format + " files have no named vertex properties; use a coordinate, or file:PATH")
      .at(file);
}

}  // namespace reeb::io
