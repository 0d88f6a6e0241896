// The layout of a hierarchy in its file: the cuts between frames, and the level table.
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/format/file_header.h"
#include "libreeb/format/frame_codec.h"
#include "ooc/reeb_writer/hierarchy_source.h"
#include "ooc/reeb_writer/record_source.h"

namespace reeb::ooc {

struct FrameCut {
  std::size_t isolated_end = 0;  // isolated nodes up to here
  std::uint64_t record_end = 0;  // records up to here, in the order of their source
  std::uint32_t finest = 0;      // finest complete version with this frame; steps + 1: none
};

struct HierarchyLayout {
  std::uint64_t records = 0;
  std::vector<VersionCounts> versions;  // entry e is version e
  std::vector<FrameCut> cuts;           // one per frame, at least one
  std::vector<LevelLine> levels;        // without file_bytes
};

// Reads all pairs, and all records without their buckets, once, and tells `hierarchy` which frame introduces each node.
// With `background`, one thread reads the records and finds their frames, and another counts.
//
// MEMORY: 32 bytes per version; until it returns, 4 1/8 per node.
// THROWS: std::logic_error that names the first impossible record, pair or step.
HierarchyLayout lay_out(HierarchySource& hierarchy, RecordSource& records, bool background);

}  // namespace reeb::ooc
