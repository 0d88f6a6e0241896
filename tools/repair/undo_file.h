// What is needed to turn a repaired mesh back into the one before, as a file (docs/REPAIR.md, The undo file).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::tools {

struct UndoRecord {
  // The repaired mesh.
  std::uint64_t vertices = 0, triangles = 0;
  std::uint64_t new_vertices = 0, new_triangles = 0;  // its last ones
  std::array<std::uint64_t, 4> digest{};
  // What it lacks, by places in the mesh before; ascending.
  std::uint32_t columns = 0;           // at least three coordinates, and properties
  std::vector<std::uint64_t> dropped;  // vertices
  std::vector<double> values;          // of each of them
  std::vector<std::uint64_t> removed;  // triangles
  std::vector<std::uint64_t> corners;  // three of each, numbered as before
  Reservation memory;                  // of a record that was read
};

// THROWS: as AtomicFile.
void write_undo(const UndoRecord& undo, const std::string& path, io::Existing existing);

// THROWS: Error{kBadInput}: no such file, not an undo file, of another version, damaged. Error{kResource} of the
// budget,
//         which must outlive the record.
// MEMORY: twice the size of the file, reserved once its parts are known to fill it.
UndoRecord read_undo(const std::string& path, MemoryBudget& budget);

}  // namespace reeb::tools
