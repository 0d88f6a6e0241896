// The place for temporary files and the memory budget, which the steps of a command share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {

struct Workspace {
  Workspace(const std::string& temp_folder, std::uint64_t memory_bytes) : budget(memory_bytes), temp(temp_folder) {}

  // The memory that one of about eight tables and buffers that exist at the same time may take.
  std::uint64_t share() const { return std::min<std::uint64_t>(budget.limit_bytes() / 8, 256u << 20); }

  MemoryBudget budget;
  io::TempDir temp;
};

}  // namespace reeb::ooc
