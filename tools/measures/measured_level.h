// A level of a .reeb file together with what is measured on its mesh.
#pragma once

#include <string>

#include "io/formats/open_mesh.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/segmentation/surface_measures.h"

namespace reeb::tools {

struct MeasureRequest {
  std::string mesh;
  io::ImageOptions image{};
  std::string temp_folder;  // not empty
  unsigned threads = 0;     // 0: all
  bool quiet = false;
};

// The measures are in the order of the level's arcs. Parallel arcs of the level are put into the order in which
// `reeb segment` numbers them (docs/SEMANTICS.md, Segmentation).
// THROWS: as ooc::segment_mesh() and Segmentation::measure(); Error{kBadInput} if the mesh cannot be read twice, or
//         if a node of the level is elsewhere in it.
ooc::MeasuredArcs measure_level(const ooc::ReebFile& file, ooc::Level& level, const MeasureRequest& request);

}  // namespace reeb::tools
