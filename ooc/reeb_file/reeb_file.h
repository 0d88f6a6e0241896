// Reads `.reeb` files: any level in time proportional to what it yields.
//
// Nothing in the file is trusted. Each byte is under a checksum that is verified before the byte is used, and no memory
// is reserved because of a count alone. A file that was cut off, or is damaged after its header, yields the levels that
// its whole frames cover.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/format/file_header.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/graph/settled_node.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::ooc {

class FrameFile;

// Whether `bytes` begins like a `.reeb` file. Eight bytes are enough.
bool is_reeb_file(std::span<const std::byte> bytes);
// The same for a file; false if it cannot be read.
bool is_reeb_file(const std::string& path);

// A graph at one version.
struct Level {
  std::uint32_t version = 0;
  double threshold = 0;  // the smallest threshold that yields it
  ReebGraph graph;
  ArcBuckets buckets;  // of graph's arcs; empty without an embedding
};

// A pair by its nodes.
struct PairRow {
  SettledNode lo, hi;
  PairType type = PairType::kExt0;
  bool kept = false;
};

// The same without positions.
struct PairKeys {
  SweepKey lo, hi;
  PairType type = PairType::kExt0;
  bool kept = false;
};

// A version is a number of cancellations: 0 is the full graph, header().steps the coarsest level.
//
// THREADS: any number may call const members of one object at the same time.
// TIME:    opening reads the header, the level table and the seek table. A question for a version reads the
//          frames between two lines of the level table; load() the frames that the version needs.
// MEMORY:  the two tables, 8 bytes per frame of about 128 KiB; what a call returns, and two frames during it.
//          The file stays open and must not change; if it shrinks, that is an Error.
class ReebFile {
 public:
  // Reads header, level table and seek table.
  // THROWS, as all members: Error{kBadInput} with path and byte offset.
  explicit ReebFile(const std::string& path);
  ReebFile(ReebFile&&) noexcept;
  ReebFile& operator=(ReebFile&&) noexcept;
  ~ReebFile();

  const FileHeader& header() const;
  std::span<const LevelLine> levels() const { return header().levels; }
  const std::string& path() const;
  std::uint64_t file_bytes() const;
  // All of the file, which is the one that was opened, also if another one has its name by now.
  // REQUIRES: bytes.size() == file_bytes().
  void read_all(std::span<std::byte> bytes) const;

  // Null for a whole file; else what is wrong after the header, and where. Levels that need the missing part are
  // refused.
  const Error* damage() const;

  // The version after all cancellations of persistence below `threshold`.
  std::uint32_t version_at(double threshold) const;
  // The finest version with at most this many nodes, or with at most this much memory as level_memory counts it.
  // THROWS: Error{kBadInput} with the size of the coarsest version if even that is larger.
  std::uint32_t finest_with_nodes(std::uint64_t nodes) const;
  std::uint32_t finest_with_memory(std::uint64_t bytes) const;

  // Version 0 is the full graph. Reads only the frames that the version needs.
  Level load(std::uint32_t version = 0) const;
  // The graph alone, without positions and buckets.
  // MEMORY: kGraphMemoryBytes for each node or arc, whichever are more, of the nodes and arcs in the frames that it
  // reads.
  ReebGraph load_graph(std::uint32_t version = 0) const;
  static constexpr std::uint64_t kGraphMemoryBytes = 72;

  // In the order of cancelling, Ext0 last. Also THROWS for a file without a hierarchy.
  // MEMORY: 48 bytes per node, in addition to the rows.
  std::vector<PairRow> pairs() const;
  // The same one after the other, without positions. MEMORY: 24 bytes per node.
  void for_each_pair(const std::function<void(const PairKeys&)>& visit) const;

  // Checks everything that can be checked: checksums and digest, order, counts of every version, level table, pairs
  // against Betti numbers. With an embedding it also checks that every vertex of the mesh is a node or in a bucket.
  // MEMORY: about 108 bytes per arc record.
  void verify() const;

 private:
  friend class ProgressiveGraph;
  void require_hierarchy(const char* what) const;
  Level load(std::uint32_t version, bool embedded) const;

  std::unique_ptr<const FrameFile> frames_;
};

}  // namespace reeb::ooc
