// Vertices with the arcs on which they lie, taken in any order and delivered by index.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/sweep_key.h"
#include "ooc/tables/partition_logs.h"

namespace reeb::ooc {

// A vertex lies on an arc or is a node; `number` is that of the arc or the node.
struct VertexPlace {
  enum class Kind : std::uint32_t { kNone, kArc, kNode };
  double value = 0;
  std::uint32_t number = 0;
  Kind kind = Kind::kNone;
};

// What errors name.
struct PlacedNames {
  std::string mesh, graph;  // files; the mesh may have none
};

// Records of 16 bytes, divided by ranges of indices and kept on disk.
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: 16 KiB for each range; to read, 16 bytes for each vertex of a range.
class PlacedVertices {
 public:
  static constexpr std::uint64_t kLeastRange = 1 << 16, kMostRanges = 1024;

  // All indices are below `bound`.
  PlacedVertices(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t bound, PlacedNames names);

  // THROWS: Error{kBadInput} if the vertex is not below the bound: it is one of another mesh.
  void add_on_arc(const SweepKey& vertex, std::uint32_t arc) { add(vertex, arc, 0); }
  void add_node(const SweepKey& vertex, std::uint32_t node) { add(vertex, node, kNodeBit); }

  std::uint64_t bound() const { return bound_; }
  std::uint64_t size() const { return size_; }

  // The next vertices by index: kNone where none was added. Empty at the end. rewind() starts over.
  // THROWS: std::logic_error if a vertex was added twice.
  std::span<const VertexPlace> read();
  void rewind() { next_range_ = 0; }

 private:
  static constexpr std::uint32_t kNodeBit = std::uint32_t{1} << 31;
  struct Record {
    double value;
    std::uint32_t offset, number;
  };

  void add(const SweepKey& vertex, std::uint32_t number, std::uint32_t bit);

  PlacedNames names_;
  std::uint64_t bound_, range_;
  std::uint64_t size_ = 0;
  Reservation charge_;
  std::optional<PartitionLogs<Record>> logs_;
  std::vector<VertexPlace> places_;  // of the range that was read last
  std::uint64_t next_range_ = 0;
};

}  // namespace reeb::ooc
