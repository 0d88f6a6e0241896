// Measures the parts of a surface that lie on the arcs of a graph (docs/SEMANTICS.md, Measures of arcs).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/ids.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/graph/arc_measures.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/segmentation/arc_chains.h"
#include "libreeb/segmentation/arc_paths.h"
#include "libreeb/segmentation/chain_measures.h"
#include "libreeb/segmentation/triangle_levels.h"
#include "ooc/sorting/external_sort.h"
#include "ooc/tables/paged_table.h"
#include "ooc/tables/vertex_column.h"

namespace reeb::ooc {

struct MeasuredArcs {
  std::vector<ArcMeasures> arcs;               // in the order of the graph
  std::vector<std::array<double, 3>> centers;  // by arc: the mean of the positions of its vertices
  // Of triangles that run over a place where it is not known which arc they follow; of those with a dropped corner.
  double doubtful_area = 0, dropped_area = 0;
  double area = 0;  // of all triangles
};

struct MeasureOptions {
  std::uint64_t table_bytes = 64 << 20;  // at most, for vertices
  std::uint64_t sort_bytes = 16 << 20;
  bool background = true;
  std::function<void()> poll = {};  // called often; may throw to stop
};

// Add all vertices by index, and each triangle after its corners; then finish().
//
// THROWS: Error{kResource} of the budget or the disk.
// MEMORY: pages of a table of 24 to 40 bytes for each vertex, within the allowance; 70 bytes for each arc, 40 for
//         each node; 96 for each triangle that the longest contour crosses.
class SurfaceMeasures {
 public:
  using Corners = std::array<VertexId, 3>;
  // The arc or the node with the number -1 - label; kDropped.
  using Label = std::int64_t;
  static constexpr Label kDropped = std::int64_t{-1} << 63;

  // All must outlive this.
  SurfaceMeasures(const ReebGraph& graph, const io::TempDir& temp, MemoryBudget& budget, const MeasureOptions& options);

  // The next vertices. coordinates[k] has those of the k-th axis; axes that are missing are 0.
  void add_vertices(std::span<const Label> labels, std::span<const double> values,
                    std::span<const std::vector<double>> coordinates);
  void add_triangle(const Corners& corners);
  // REQUIRES: everything was added.
  MeasuredArcs finish();

 private:
  struct Corner;
  Corner corner(VertexId vertex);
  void add_piece(std::uint32_t arc, double from, double to);
  void end_part();
  void add_side(const Corner& lo, const Corner& hi);
  void add_level_triangle(const std::array<Corner, 3>& corners);

  const ReebGraph& graph_;
  MemoryBudget& budget_;
  MeasureOptions options_;
  Reservation memory_;
  MeasuredArcs measured_;
  ArcChains chains_;
  ArcPaths paths_;
  PagedTable<Label> labels_;
  VertexColumn values_, x_, y_, z_;
  ExternalSort<CrossingTriangle> crossing_;
  std::vector<double> zeros_;
  std::vector<ArcId> path_;
  // Of the present triangle.
  std::array<double, 3> levels_{};
  const TriangleLevels* triangle_ = nullptr;
  CrossingTriangle part_;  // that is not added yet: it can go on in its chain
};

}  // namespace reeb::ooc
