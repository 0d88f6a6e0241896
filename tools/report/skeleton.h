// The skeleton of a page: all levels from a fine one to the coarsest, with lines in space.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "ooc/reeb_file/reeb_file.h"

namespace reeb::tools {

// What tools/web/data.js reads. Positions and values are rounded to 16 bits of the box and of the range; lines lose the
// points that do not bend them, and at most 60,000 stay. Nodes, arcs and thresholds are exact.
//
//   box       {min, size}: a position is min + size * q / 65535, on each axis
//   values    {min, size}: likewise
//   nodes     {vertex, value, place}: lists by node; place has 3 numbers a node, base64 of 16 bits each
//   arcs      {lo, hi, born, died, points, line}: lists by record; a version e has those with born <= e < died (died
//             null: never); points counts the inner points of its line; line has 4 numbers a point, the last its value
//   levels    {version, threshold, nodes, arcs}: lists by level that some threshold yields, the finest first
//   isolated  nodes without arcs, which all levels have
//
// MEMORY: records of the versions from `finest` on, with the points of their lines.
nlohmann::ordered_json skeleton_json(const ooc::ReebFile& file, std::uint32_t finest);

}  // namespace reeb::tools
