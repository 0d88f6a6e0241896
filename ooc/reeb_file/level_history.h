// All versions of a `.reeb` file from one to the coarsest, as records: what a slider moves through.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "libreeb/format/frame_codec.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/graph/settled_node.h"

namespace reeb::ooc {

struct LevelHistory {
  std::vector<SettledNode> nodes;       // by their number in the file; also some that only finer versions have
  std::vector<std::uint32_t> isolated;  // the nodes without arcs, which every version has
  std::vector<VersionCounts> versions;  // the finest first: entry i is version finest + i
};

// Calls `visit` with each record that lives after version `finest`, in the order of the file, with its buckets. Version
// e >= finest has the arcs with born <= e < died, and the nodes that these name.
// TIME:   O(frames that the version needs).
// MEMORY: what it returns, and two frames during it.
// THROWS: as ReebFile; if there is no version `finest`.
using VisitRecord = std::function<void(const FileArc& arc, const SettledNode& lo, const SettledNode& hi,
                                       std::span<const Bucket> buckets)>;
LevelHistory read_history(const std::string& path, std::uint32_t finest, const VisitRecord& visit);

}  // namespace reeb::ooc
