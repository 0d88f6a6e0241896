// One row for each loop of the first function: which curves of which functions stand for different defects.
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "libreeb/defects/defect_lengths.h"
#include "tools/defects/curve_search.h"
#include "tools/defects/loop_list.h"

namespace reeb::tools {

struct DefectRow {
  std::size_t function = 0;  // of the list
  SettledNode lo, hi;
  double persistence = 0, percent = 0;
  // The shorter one; if its kind is clear, the shorter of those along edges. If none was found, its place is that of
  // the nodes.
  FoundCurve curve;
  std::vector<VertexId> other_path;  // the other curve, if it was found along edges
  DefectKind kind = DefectKind::kUnclear;
  double length_contour = std::numeric_limits<double>::infinity();
  double length_cycle = std::numeric_limits<double>::infinity();
  double length() const { return std::min(length_contour, length_cycle); }
};

struct DefectTable {
  std::vector<DefectRow> rows;  // the most likely defect first
  SuggestedLength suggestion;
};

// Takes curves by length, each if it crosses none of those taken before an odd number of times, and bounds no part of
// the surface together with them. Reads the mesh once more, if loops are near each other; or as often as the memory
// requires. Loops of these names that have no row get one at the end.
DefectTable make_rows(const ValuedMesh& mesh, const LoopList& list, const LoopCurvesFound& found,
                      const SearchOptions& options, const std::set<LoopName>& named = {});

}  // namespace reeb::tools
