// Where everything of a hierarchy goes in its file: the order of arc records, the cuts between
// frames, and the level table (DESIGN.md 6).
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/format/frame_codec.h"
#include "libreeb/format/reeb_format.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/arc_buckets.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::ooc {

struct FrameCut {
  std::size_t isolated_end = 0;  // isolated nodes up to here
  std::size_t record_end = 0;    // records up to here, as places in HierarchyLayout::order
  std::uint32_t finest = 0;      // finest complete version with this frame; steps + 1: none
};

struct HierarchyLayout {
  std::vector<std::uint32_t> order;       // of arc records: by died descending, then canonical
  std::vector<std::uint32_t> isolated;    // nodes without any record, ascending
  std::vector<VersionCounts> versions;    // entry e is version e
  std::vector<FrameCut> cuts;             // one a frame, at least one
  std::vector<LevelLine> levels;          // without file_bytes
};

// O(records log(records)). REQUIRES: check_hierarchy() passed.
HierarchyLayout lay_out(const ReebGraph& graph, const Hierarchy& hierarchy, const ArcBucketsView& buckets);

// THROWS: std::logic_error that names the first record, pair or step that cannot be.
void check_hierarchy(const ReebGraph& graph, const Hierarchy& hierarchy, const ArcBucketsView& buckets);

}  // namespace reeb::ooc
