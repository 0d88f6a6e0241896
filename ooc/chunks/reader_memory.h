// The reservation of what a mesh reader holds and what grows with the mesh.
#pragma once

#include <string>

#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::ooc {

class ReaderMemory {
 public:
  explicit ReaderMemory(MemoryBudget& budget) : reservation_(budget.reserve("mesh reader", 0)) {}

  // To be called after each batch. THROWS: Error{kResource} with the reader's own hint, if it has one.
  void update(const MeshReader& reader) {
    const std::uint64_t bytes = reader.memory_bytes();
    if (bytes == reservation_.bytes()) return;
    try {
      reservation_.resize(bytes);
    } catch (const Error& error) {
      const std::string hint = reader.memory_hint();
      if (hint.empty()) throw;
      throw error.with_hint(hint);
    }
  }

 private:
  Reservation reservation_;
};

}  // namespace reeb::ooc
