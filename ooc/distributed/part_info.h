// What a fragment is of: the mesh, the function and the options; and which shares are in it (docs/FORMAT.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libreeb/base/state_stream.h"
#include "libreeb/base/value_range.h"
#include "libreeb/parts/part_set.h"
#include "libreeb/port/simplex_counts.h"
#include "libreeb/sweep/sweep_options.h"
#include "ooc/distributed/mesh_share.h"
#include "ooc/run/compute.h"

namespace reeb::ooc {

// The same wherever a copy of the mesh is, and whenever it was made.
struct WholeMeshInfo {
  std::uint64_t bytes = 0, digest = 0;  // of its file
  std::uint64_t reading = 0;            // digest of the options by which it is read
  Shares shares;
  std::uint64_t numbers = 0;  // of its vertices, also of those that are left out of a grid
  SimplexCounts simplices{};  // as listed
};

struct PartInfo {
  WholeMeshInfo mesh;
  std::string function;
  std::uint64_t values_digest = 0;  // of the file of the function's values
  double denoise = 0;
  bool denoise_is_share = false;
  std::uint32_t buckets = 0;
  bool graph_only = false;
  std::vector<PartSpan> runs;  // of shares, ascending

  ValueRange range;  // of the vertices in it; min > max without any
  std::uint64_t degenerate_triangles = 0, unused_vertices = 0, removed_pairs = 0;
  std::uint64_t settled_nodes = 0, settled_arcs = 0;
  LiveMaximum live;

  // The options of all that is in it. A threshold that is a share of the range is left to the last pass.
  SweepOptions sweep() const;
};

WholeMeshInfo identify_whole_mesh(const MeshInput& input);

// Why two fragments cannot be glued: "is of another mesh"; empty if they can, apart from their shares.
std::string difference(const PartInfo& part, const PartInfo& first);

void write_info(StateWriter& out, const PartInfo& info);
// THROWS: DamagedState.
PartInfo read_info(StateReader& in);

}  // namespace reeb::ooc
