// The place for temporary files and the memory budget, which the steps of a command share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {

// What the process itself and the windows of files take of a limit. A limit below 16 MiB is too small for a process; it
// counts for tables alone.
inline std::uint64_t set_aside_of(std::uint64_t memory_bytes) {
  constexpr std::uint64_t kProcess = std::uint64_t{9} << 20, kLeast = std::uint64_t{16} << 20;
  return memory_bytes == MemoryBudget::kUnlimited || memory_bytes < kLeast ? 0 : kProcess;
}

struct Workspace {
  Workspace(const std::string& temp_folder, std::uint64_t memory_bytes)
      : budget(memory_bytes - set_aside_of(memory_bytes), set_aside_of(memory_bytes)), temp(temp_folder) {}

  // The memory that one of about eight tables and buffers that exist at the same time may take.
  std::uint64_t share() const { return std::min<std::uint64_t>(budget.limit_bytes() / 8, 256u << 20); }

  MemoryBudget budget;
  io::TempDir temp;
};

}  // namespace reeb::ooc
