// What the steps of a command share: the place for temporary files, and the memory account.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "libreeb/base/memory_budget.h"
#include "ooc/temp_dir.h"

namespace reeb::tools {

struct Workspace {
  Workspace(const std::string& temp_folder, std::uint64_t memory_bytes) : budget(memory_bytes), temp(temp_folder) {}

  // What one of about eight tables and buffers that live at the same time may take.
  std::uint64_t share() const { return std::min<std::uint64_t>(budget.limit_bytes() / 8, 256u << 20); }

  MemoryBudget budget;
  ooc::TempDir temp;
};

}  // namespace reeb::tools
