// The digest of a mesh that is read in batches.
#pragma once

#include <cstdint>
#include <span>

#include "io/file/checksum.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::ooc {

class BatchDigest {
 public:
  void add(const MeshBatch& batch) {
    for (const auto& column : batch.coordinates) digest_.add(std::as_bytes(std::span(column)));
    for (const auto& column : batch.properties) digest_.add(std::as_bytes(std::span(column)));
    for (const auto& corners : batch.simplices) digest_.add(std::as_bytes(std::span(corners)));
    digest_.add(std::as_bytes(std::span(batch.finalized)));
  }
  std::uint64_t value() const { return digest_.value(); }

 private:
  io::RunningDigest digest_;
};

}  // namespace reeb::ooc
